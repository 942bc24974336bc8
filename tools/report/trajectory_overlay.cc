#include "tools/report/trajectory_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

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

struct Mark {
  const char* style;
  Vector2d at;        // on the sheet
  std::string label;  // empty: another one has it
};

std::string Draw(const std::vector<Mark>& marks) {
  std::string out;
  for (const Mark& m : marks) {
    const std::string x = Decimal(m.at.x());
    fmt::format_to(std::back_inserter(out), "<g class=\"mark {}\"><circle cx=\"{}\" cy=\"{}\" r=\"9\"/>", m.style, x, Decimal(m.at.y()));
    if (!m.label.empty())
      fmt::format_to(std::back_inserter(out), "<text x=\"{}\" y=\"{}\" font-size=\"17\">{}</text>", x, Decimal(m.at.y() - 15), m.label);
    out += "</g>\n";
  }
  return out;
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
  std::vector<Mark> marks;
  const auto mark = [&](const char* style, const runtime::StampedPose& pose, const char* label) {
    if (StoreyAt(graph, pose.T.translation().z()) != storey) return;
    constexpr double kApart = 80;  // nearer than this one label would stand on the other
    const Vector2d at(sheet.x(Position(pose).x()), sheet.y(Position(pose).y()));
    const auto near = std::find_if(marks.begin(), marks.end(), [&](const Mark& m) {
      return !m.label.empty() && std::abs(m.at.x() - at.x()) < kApart && std::abs(m.at.y() - at.y()) < kApart / 4;
    });
    const bool is_apart = near == marks.end();
    if (!is_apart) near->label += std::string(", ") + label;
    marks.push_back({style, at, is_apart ? label : ""});
  };
  mark("start", way.front(), "start");
  if (!run.online.empty()) mark("fix", run.online.front(), "first fix");
  mark("end", way.back(), "end");
  return out + Draw(marks);
}

}  // namespace plumb::tools
