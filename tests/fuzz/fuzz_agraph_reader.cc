// Any bytes: the reader refuses them or gives a graph whose every id can be followed.
#include "schema/agraph_json.h"
#include "schema/agraph_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (const auto graph = plumb::ReadAGraph({data, size})) (void)plumb::AGraphToJson(*graph);
  return 0;
}
