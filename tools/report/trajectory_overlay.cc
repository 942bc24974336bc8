#include "tools/report/trajectory_overlay.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <set>

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kStep_m = 0.05;  // poses closer than this to the last drawn one are left out
constexpr int kColors = 48;

// The stretch of the way drawn so far in one style.
struct Stretch {
  std::string data;
  int color = -1;  // -1: not localized
};

std::string Draw(const Stretch& s) {
  if (s.color < 0) return fmt::format("<path class=\"way unfixed\" d=\"{}\"/>\n", s.data);
  return fmt::format("<path class=\"way\" stroke=\"{}\" d=\"{}\"/>\n", TimeColor(static_cast<double>(s.color) / (kColors - 1)), s.data);
}

std::set<long long> LocalizedMicroseconds(const Run& run) {
  std::set<long long> out;
  for (const VerdictRow& v : run.verdicts) {
    if (v.verdict == "localized") out.insert(std::llround(v.stamp_s * 1e6));
  }
  return out;
}

std::string Marker(const char* style, const Vector2d& at, const char* label, const Sheet& sheet) {
  const double x = sheet.x(at.x()), y = sheet.y(at.y());
  return fmt::format("<g class=\"mark {}\"><circle cx=\"{}\" cy=\"{}\" r=\"9\"/><text x=\"{}\" y=\"{}\" font-size=\"17\">{}</text></g>\n",
                     style, Decimal(x), Decimal(y), Decimal(x), Decimal(y - 15), label);
}

Vector2d Position(const runtime::StampedPose& pose) { return pose.T.translation().head<2>(); }

}  // namespace

std::string TrajectoryStyle() {
  return R"(.plan .way{fill:none;stroke-width:5;stroke-linejoin:round;stroke-linecap:round}
.plan .unfixed{stroke:var(--soft);stroke-width:4;stroke-dasharray:3 9}
.plan .mark circle{stroke:var(--paper);stroke-width:2.5}
.plan .mark text{paint-order:stroke;stroke:var(--paper);stroke-width:6;stroke-linejoin:round}
.plan .start circle{fill:#3b1c8c}.plan .fix circle{fill:#1e9b8a}.plan .end circle{fill:#d9a400}
)";
}

StoreyId StoreyAt(const AGraph& graph, double z_m) {
  StoreyId best(0);
  double best_distance_m = std::numeric_limits<double>::max();
  for (size_t i = 0; i < graph.storeys.size(); ++i) {
    const Storey& s = graph.storeys[i];
    const double distance_m = std::max({s.elevation_m - z_m, z_m - s.elevation_m - s.height_m, 0.0});
    if (distance_m >= best_distance_m) continue;
    best_distance_m = distance_m;
    best = StoreyId(i);
  }
  return best;
}

std::string DrawTrajectory(const AGraph& graph, StoreyId storey, const Run& run, const Sheet& sheet) {
  const runtime::Trajectory& way = run.smoothed;
  if (way.empty()) return {};
  const std::set<long long> localized = LocalizedMicroseconds(run);
  const double begin_s = way.front().stamp_s, span_s = std::max(1e-9, way.back().stamp_s - begin_s);
  std::string out;
  Stretch stretch;
  Vector2d last = Vector2d::Zero();
  bool has_last = false;
  for (const runtime::StampedPose& pose : way) {
    const Vector2d at = Position(pose);
    if (StoreyAt(graph, pose.T.translation().z()) != storey) {
      if (!stretch.data.empty()) out += Draw(stretch);
      stretch = {};
      has_last = false;
      continue;
    }
    if (has_last && (at - last).norm() < kStep_m) continue;
    const bool is_localized = localized.contains(std::llround(pose.stamp_s * 1e6));
    const int color = is_localized ? static_cast<int>((kColors - 1) * (pose.stamp_s - begin_s) / span_s) : -1;
    if (has_last) stretch.data += "L" + sheet.At(at);
    if (color != stretch.color || !has_last) {
      if (has_last) out += Draw(stretch);
      stretch = {"M" + sheet.At(at), color};
    }
    last = at;
    has_last = true;
  }
  if (!stretch.data.empty()) out += Draw(stretch);
  const auto mark = [&](const char* style, const runtime::StampedPose& pose, const char* label) {
    if (StoreyAt(graph, pose.T.translation().z()) == storey) out += Marker(style, Position(pose), label, sheet);
  };
  mark("start", way.front(), "start");
  if (!run.online.empty()) mark("fix", run.online.front(), "first fix");
  mark("end", way.back(), "end");
  return out;
}

}  // namespace plumb::tools
