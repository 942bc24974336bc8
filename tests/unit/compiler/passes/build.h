// Runs all passes, verifiers on, on a plan made by hand.
#pragma once

#include <gtest/gtest.h>

#include "compiler/passes/build_agraph.h"

namespace plumb::compiler {

inline Built Build(PlanIr plan, DiagnosticSink& sink, PassOptions options = {}) {
  options.verify = true;
  std::optional<Built> built = BuildAGraph(plan, options, sink);
  for (const Diagnostic& d : sink.all()) EXPECT_NE(d.severity, Severity::kError) << d.message;
  EXPECT_TRUE(built.has_value());
  return built.value_or(Built{});
}

inline Built Build(PlanIr plan, PassOptions options = {}) {
  DiagnosticSink sink;
  return Build(std::move(plan), sink, options);
}

// A floor of walls with these outlines.
inline Floor FloorOf(const std::vector<Ring>& walls) {
  Floor floor;
  for (uint32_t i = 0; i < walls.size(); ++i) floor.footprints.push_back({FootprintKind::kWall, i, i, true, {walls[i]}});
  return floor;
}

// Triangles, each with a side through (0.3, 0.7). Snapped within this radius, less than doubles resolve there, the pieces of these sides
// that rounding bends cross each other again.
inline constexpr double kTangleRadius_m = 1e-15;
inline std::vector<Ring> Tangle() {
  return {{{0.1, -4.6}, {0.5, 6}, {-5, 0.9}}, {{3.8, -3.8}, {-3.2, 5.2}, {-4.2, -2.8}}, {{-3.6, -0.7}, {4.2, 2.1}, {-1.1, 4.6}}};
}

inline size_t CountOf(const DiagnosticSink& sink, DiagnosticKind kind) {
  size_t n = 0;
  for (const Diagnostic& d : sink.all()) n += d.kind == kind;
  return n;
}

inline const Room* FindRoom(const AGraph& graph, const std::string& name) {
  for (const Room& r : graph.rooms) {
    if (r.name == name) return &r;
  }
  return nullptr;
}

inline const Wall* FindWall(const AGraph& graph, const std::string& guid) {
  for (const Wall& w : graph.walls) {
    if (w.guid == guid) return &w;
  }
  return nullptr;
}

}  // namespace plumb::compiler
