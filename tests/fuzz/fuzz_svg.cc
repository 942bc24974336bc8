// Any bytes as an SVG file: an error or a plan, never a crash.
#include <cstdint>
#include <string>

#include "compiler/frontends/svg/svg_frontend.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace plumb::compiler;
  // Limits at which one input stays below a second.
  DrawingFileOptions options;
  options.plan.mass.max_vertices = 5000;
  const Source source{
      .path = "plan.svg", .bytes = std::string(reinterpret_cast<const char*>(data), size), .sha256 = {}, .format = SourceFormat::kSvg};
  DiagnosticSink diagnostics;
  PlanIr plan;
  (void)AppendSvg(source, {{}, "Storey", {}, 0.0}, options, plan, diagnostics);
  return 0;
}
