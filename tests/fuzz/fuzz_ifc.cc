// Any bytes as an IFC file: an error or a plan, never a crash.
#include <cstdint>
#include <string>

#include "compiler/frontends/ifc/ifc_frontend.h"
#include "compiler/source/source.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace plumb::compiler;
  // Limits at which one input stays below a second.
  IfcOptions options;
  options.max_triangles_per_element = 20000;
  options.max_triangles = 100000;
  Source source{
      .path = "plan.ifc", .bytes = std::string(reinterpret_cast<const char*>(data), size), .sha256 = {}, .format = SourceFormat::kUnknown};
  source.format = DetectFormat(source.bytes);
  DiagnosticSink diagnostics;
  (void)ReadIfc(source, diagnostics, options);
  return 0;
}
