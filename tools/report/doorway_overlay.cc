#include "tools/report/doorway_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <tuple>
#include <vector>

namespace plumb::tools {
namespace {

using Eigen::Vector2d;

constexpr double kDepth_m = 0.3;   // of a doorway without a wall
constexpr double kBeside_m = 0.3;  // of the text, from the wall

bool IsOff(const DoorwayEntry& d) { return d.status == "deviated" || d.status == "missing"; }

double Size(const DoorwayEntry& d) { return std::max(std::abs(d.shift_m), std::abs(d.width_deviation_m)); }

// "shift +14.3 cm, width -5.0 cm", what is worth a word of it.
std::string Amount(const DoorwayEntry& d) {
  constexpr double kWorth_m = 0.02;
  if (d.status == "missing") return "walled up";
  std::string out;
  if (std::abs(d.shift_m) >= kWorth_m) out = "shift " + Signed(100 * d.shift_m, 1) + " cm";
  if (std::abs(d.width_deviation_m) >= kWorth_m)
    out += (out.empty() ? "width " : ", width ") + Signed(100 * d.width_deviation_m, 1) + " cm";
  return out;
}

// Of a doorway with its wall, as the longest of the wall's faces that deviate is drawn.
Eigen::Isometry2d MotionOf(const AGraph& plan, const Deviations& deviations, WallId wall) {
  const SurfaceEntry* entry = nullptr;
  for (const SurfaceEntry& s : deviations.surfaces) {
    const Surface& surface = plan.surfaces[s.id.index()];
    if (!wall.valid() || surface.wall != wall || s.status != "deviated") continue;
    if (!entry || surface.length_m() > plan.surfaces[entry->id.index()].length_m()) entry = &s;
  }
  Eigen::Isometry2d motion = Eigen::Isometry2d::Identity();
  if (!entry) return motion;
  const Surface& surface = plan.surfaces[entry->id.index()];
  const Vector2d pivot = surface.midpoint();
  motion.linear() = Eigen::Rotation2Dd(entry->rotation_deg * std::numbers::pi / 180).toRotationMatrix();
  motion.translation() = pivot + entry->translation_m * surface.normal.head<2>() - motion.linear() * pivot;
  return motion;
}

std::string RoomName(const AGraph& plan, RoomId room) { return room.valid() ? EscapeXml(plan.rooms[room.index()].name) : "the outside"; }

// On the spot: to which side, seen from which room.
std::string Sense(const AGraph& plan, const Doorway& doorway, const DoorwayEntry& d) {
  if (d.status != "deviated") return "";
  return fmt::format("<small>to the {} seen from {}</small>", d.shift_m >= 0 ? "left" : "right", RoomName(plan, doorway.room_a));
}

std::string Row(const AGraph& plan, const DoorwayEntry& d) {
  const Doorway& doorway = plan.doorways[d.id.index()];
  const std::string head =
      fmt::format("<tr{}><td class=\"t\">{}<small>{}</small></td><td class=\"t\">{} &ndash; {}</td>", IsOff(d) ? " class=\"off\"" : "",
                  doorway.name.empty() ? fmt::format("doorway {}", d.id.value) : EscapeXml(doorway.name), EscapeXml(d.guid),
                  RoomName(plan, doorway.room_a), RoomName(plan, doorway.room_b));
  if (d.status == "missing")
    return head + fmt::format("<td class=\"t\">walled up</td><td></td><td>{:.2f}</td><td></td><td></td></tr>\n", doorway.width_m);
  return head +
         fmt::format("<td class=\"t\">{}</td><td>{} &plusmn; {:.1f}{}</td><td>{:.2f}</td><td>{} &plusmn; {:.1f}</td><td>{:.3f}</td></tr>\n",
                     d.status == "deviated" ? "deviated" : "as planned", Signed(100 * d.shift_m, 1), 100 * d.sigma_shift_m,
                     Sense(plan, doorway, d), doorway.width_m, Signed(100 * d.width_deviation_m, 1), 100 * d.sigma_width_m, d.p_deviated);
}

}  // namespace

std::string DoorwayStyle() {
  return R"(.plan .doorway{stroke:#b8860b;stroke-width:5;fill:#ffd54f;fill-opacity:.55}
.plan .doorway-amount{paint-order:stroke;stroke:var(--paper);stroke-width:7;stroke-linejoin:round;font-weight:600}
)";
}

std::string DrawDoorways(const AGraph& plan, StoreyId storey, const Deviations& deviations, const Sheet& sheet) {
  std::string out;
  for (const DoorwayEntry& entry : deviations.doorways) {
    const Doorway& d = plan.doorways[entry.id.index()];
    if (!IsOff(entry) || d.storey != storey) continue;
    const Vector2d through(std::cos(d.yaw_rad), std::sin(d.yaw_rad)), along(-through.y(), through.x());
    const double thickness_m = d.wall.valid() ? plan.walls[d.wall.index()].thickness_m : kDepth_m;
    const Eigen::Isometry2d motion = MotionOf(plan, deviations, d.wall);
    const Vector2d middle = d.position.head<2>() + entry.shift_m * along, half = 0.5 * (d.width_m + entry.width_deviation_m) * along,
                   deep = 0.5 * thickness_m * through;
    fmt::format_to(std::back_inserter(out), "<path class=\"{}\" d=\"{}\"/>\n", entry.status == "missing" ? "missing" : "doorway",
                   sheet.Closed({motion * (middle - half - deep), motion * (middle + half - deep), motion * (middle + half + deep),
                                 motion * (middle - half + deep)}));
    const Vector2d at = motion * (middle + (0.5 * thickness_m + kBeside_m) * through);
    fmt::format_to(std::back_inserter(out),
                   "<text class=\"doorway-amount\" text-anchor=\"middle\" x=\"{}\" y=\"{}\" font-size=\"18\">{}</text>\n",
                   Decimal(sheet.x(at.x())), Decimal(sheet.y(at.y())), Amount(entry));
  }
  return out;
}

std::string DoorwayTable(const AGraph& plan, const Deviations& deviations) {
  std::vector<const DoorwayEntry*> rows;
  for (const DoorwayEntry& d : deviations.doorways) {
    if (d.status != "unobserved") rows.push_back(&d);
  }
  if (rows.empty()) return {};
  std::stable_sort(rows.begin(), rows.end(), [](const DoorwayEntry* a, const DoorwayEntry* b) {
    return std::tuple(IsOff(*a), Size(*a)) > std::tuple(IsOff(*b), Size(*b));
  });
  std::string body;
  for (const DoorwayEntry* d : rows) body += Row(plan, *d);
  const size_t rest = deviations.doorways.size() - rows.size();
  return fmt::format(
      "<h2>Doorways</h2>\n<div class=\"scroll\"><table><thead><tr><th class=\"t\">doorway</th><th class=\"t\">between</th><th "
      "class=\"t\">verdict</th><th>shift along the wall &plusmn; &sigma;, cm</th><th>planned width, m</th><th>width off &plusmn; &sigma;, "
      "cm</th><th>P(deviated)</th></tr></thead><tbody>\n{}</tbody></table></div>\n{}",
      body,
      rest == 0 ? ""
                : fmt::format("<p class=\"note\">Doorways whose two jambs were not seen well enough to judge: {} of {}.</p>\n", rest,
                              deviations.doorways.size()));
}

}  // namespace plumb::tools
