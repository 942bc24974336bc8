// Any bytes: the reader refuses them or returns a graph that can be written and read again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "schema/agraph_json.h"
#include "schema/agraph_reader.h"
#include "schema/agraph_writer.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto graph = plumb::ReadAGraph({data, size});
  if (!graph) return 0;
  if (plumb::AGraphToJson(*graph).empty()) std::abort();
  if (!plumb::ReadAGraph(plumb::WriteAGraph(*graph))) std::abort();
  return 0;
}
