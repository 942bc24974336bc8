#include "compiler/frontends/drawing/wall_report.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "compiler/frontends/drawing/open_outlines.h"

namespace plumb::compiler {
namespace {

constexpr double kAround_m = 1e-3;  // of a healed place: the lines that meet there

SourceLocation LocationOf(const Drawing& drawing, uint32_t path) {
  return path < drawing.paths.size() ? drawing.paths[path].location : SourceLocation();
}

std::string Place(const Eigen::Vector2d& p) { return fmt::format("({:.3f}, {:.3f})", p.x(), p.y()); }

std::string Name(const SourceLocation& location) {
  const std::string name = location.ToString();
  if (name.empty()) return "another line";
  return location.line > 0 ? fmt::format("{} (line {})", name, location.line) : name;
}

// What was healed among lines that bound no wall is nobody's business.
bool BoundsWall(const WallMass& mass, const Heal& heal) {
  Eigen::AlignedBox2d box(heal.from);
  box.extend(heal.to);
  const Eigen::Vector2d around = Eigen::Vector2d::Constant(kAround_m);
  bool bounds = false;
  mass.map.VisitEdges({box.min() - around, box.max() + around}, [&](uint32_t e) { bounds = bounds || mass.EdgeIsBoundary(e); });
  return bounds;
}

void ReportHeals(const Drawing& drawing, const WallMass& mass, DiagnosticSink& sink) {
  for (const Heal& heal : mass.heals) {
    if (!BoundsWall(mass, heal)) continue;
    sink.Emit(DiagnosticKind::kEndHealed, LocationOf(drawing, heal.path),
              fmt::format("a wall's line ends at {} m, {:.1f} mm beside {}; it is led there", Place(heal.from), 1000 * heal.distance_m(),
                          Name(LocationOf(drawing, heal.other))));
  }
}

// Marks the lines by edge.
void ReportOpenOutlines(const Drawing& drawing, const WallMass& mass, const MassOptions& options, DiagnosticSink& sink,
                        std::vector<bool>& is_told) {
  for (const OpenOutline& open : FindOpenOutlines(drawing, mass, options)) {
    for (const uint32_t e : open.edges) is_told[e] = true;
    sink.Emit(DiagnosticKind::kOutlineOpen, LocationOf(drawing, open.path),
              fmt::format("{:.1f} m of lines that lie beside each other as the sides of walls do enclose no wall; their outline is open "
                          "about {} m",
                          open.length_m, Place(open.at)),
              "close the outline there; what it was to enclose is missing from the plan");
  }
}

// Other lines on both of whose sides no wall is, with the longest.
void ReportWithoutPartner(const Drawing& drawing, const WallMass& mass, const MassOptions& options, const std::vector<bool>& is_told,
                          DiagnosticSink& sink) {
  double longest_m = 0, sum_m = 0;
  uint32_t longest = 0;
  for (uint32_t e = 0; e < mass.map.edges().size(); ++e) {
    if (!mass.IsSingle(e, drawing.paths.size()) || is_told[e]) continue;
    const double length_m = (mass.map.ToPoint(2 * e) - mass.map.FromPoint(2 * e)).norm();
    sum_m += length_m;
    if (length_m > longest_m) longest_m = length_m, longest = e;
  }
  if (sum_m <= options.min_single_m) return;
  sink.Emit(DiagnosticKind::kLinesWithoutPartner, LocationOf(drawing, mass.map.edges()[longest].source),
            fmt::format("{:.1f} m of lines have no parallel partner within {:.2f} m and are taken for no walls; the longest goes from {} "
                        "to {} m",
                        sum_m, options.max_thickness_m, Place(mass.map.FromPoint(2 * longest)), Place(mass.map.ToPoint(2 * longest))));
}

}  // namespace

void ReportWalls(const Drawing& drawing, const WallMass& mass, const MassOptions& options, DiagnosticSink& sink) {
  ReportHeals(drawing, mass, sink);
  if (mass.single_lines) {
    sink.Emit(DiagnosticKind::kSingleLineWalls, {},
              fmt::format("the walls are drawn as single lines, {:.0f} m of them; each is taken as a wall {:.2f} m thick", mass.single_m,
                          options.single_line_thickness_m));
    return;
  }
  std::vector<bool> is_told(mass.map.edges().size(), false);
  ReportOpenOutlines(drawing, mass, options, sink, is_told);
  ReportWithoutPartner(drawing, mass, options, is_told, sink);
}

}  // namespace plumb::compiler
