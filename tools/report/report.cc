#include "tools/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "schema/source_paths.h"
#include "tools/drawing/floor_plan.h"
#include "tools/drawing/plan_sheet.h"
#include "tools/drawing/room_labels.h"
#include "tools/drawing/svg.h"
#include "tools/report/deviation_overlay.h"
#include "tools/report/doorway_overlay.h"
#include "tools/report/place_overlay.h"
#include "tools/report/report_page.h"
#include "tools/report/trajectory_overlay.h"

namespace plumb::tools {
namespace {

const char* StatusText(const std::string& status) {
  if (status == "as_planned") return "as planned";
  if (status == "unobserved") return "not observed";
  return status == "missing" ? "missing" : "deviated";
}

std::string Tile(const std::string& value, const std::string& label) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>\n", value, label);
}

std::string Tiles(const RunInfo& info, const Deviations& deviations, const std::vector<WallRow>& rows) {
  const auto count = [&](const char* status) {
    return std::count_if(rows.begin(), rows.end(), [&](const WallRow& r) { return r.surface->status == status; });
  };
  const auto deviated = count("deviated"), observed = deviated + count("as_planned");
  std::string out = "<div class=\"tiles\">\n";
  out += Tile(info.time_to_localize_s ? fmt::format("{:.1f} s", *info.time_to_localize_s) : "never", "until localized");
  const double ratio = info.scans == 0 ? 0 : 100.0 * static_cast<double>(info.localized_scans) / static_cast<double>(info.scans);
  out += Tile(fmt::format("{:.0f} %", ratio), fmt::format("of {} scans localized", info.scans));
  out += Tile(fmt::format("{} of {}", deviated, observed), "observed walls deviate");
  const auto doorways = [&](auto&& counts) { return std::count_if(deviations.doorways.begin(), deviations.doorways.end(), counts); };
  out += Tile(fmt::format("{} of {}", doorways([](const DoorwayEntry& d) { return d.status == "deviated" || d.status == "missing"; }),
                          doorways([](const DoorwayEntry& d) { return d.status != "unobserved"; })),
              "observed doorways deviate");
  out += Tile(deviated > 0 ? Signed(100 * rows.front().surface->translation_m, 1) + " cm" : "none", "largest deviation");
  out += Tile(fmt::format("{}, {}", count("missing"), deviations.unplanned.size()), "walls missing, walls in no plan");
  out += Tile(Signed(100 * info.range_bias_m, 1) + " cm", "range bias of the sensor");
  out += Tile(fmt::format("{:.0f} s", info.duration_s), fmt::format("of recording, {:.0f} ms per scan", info.ms_per_scan));
  return out + "</div>\n";
}

std::string Notes(const RunInfo& info, const Deviations& deviations) {
  std::string out;
  if (!info.time_to_localize_s) {
    out += fmt::format("<p class=\"note bad\">The robot was not localized in this plan{}{}. No deviations can be stated.</p>\n",
                       info.last_reason.empty() ? "" : ": ", EscapeXml(info.last_reason));
  }
  if (info.matcher == "graph") {
    out += "<p class=\"note\">The robot was found by the rooms of its map (<code>--matcher graph</code>), not by walls and rays.</p>\n";
  }
  if (info.interrupted) out += "<p class=\"note bad\">The run was interrupted: only a part of the recording was used.</p>\n";
  if (info.untimed_scans > 0) {
    out += fmt::format(
        "<p class=\"note bad\">{} of {} scans had no usable time per point: walls seen while the robot turned are bent, by centimetres and "
        "degrees.</p>\n",
        info.untimed_scans, info.scans);
  }
  if (info.unreadable_scans > 0) out += fmt::format("<p class=\"note bad\">{} scans could not be read.</p>\n", info.unreadable_scans);
  if (!deviations.gauge.empty()) out += fmt::format("<p class=\"note\">{}</p>\n", EscapeXml(deviations.gauge));
  return out;
}

// The try whose places are worth showing: the last one of a run that has no place.
const TryRow* OpenTry(const Run& run) {
  const bool found = std::any_of(run.verdicts.begin(), run.verdicts.end(), [](const VerdictRow& v) { return v.verdict == "localized"; });
  return found || !run.smoothed.empty() || run.tries.empty() ? nullptr : &run.tries.back();
}

// A wall that goes up through several storeys is judged as one. Of one that nobody visited, only what was seen of it is shown as judged.
Deviations WhereSeen(const AGraph& plan, StoreyId storey, Deviations deviations) {
  for (SurfaceEntry& s : deviations.surfaces) {
    if (plan.surfaces[s.id.index()].storey == storey && s.points <= 0) s.status = "unobserved";
  }
  return deviations;
}

std::string Figure(const AGraph& plan, StoreyId storey, const Run& run, const Deviations& deviations, const std::vector<WallRow>& rows,
                   double limit_m) {
  const Sheet sheet = SheetOf(plan, storey);
  const TryRow* open = OpenTry(run);
  return fmt::format(
      "<figure><figcaption>{}</figcaption>\n<svg class=\"plan\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"floor plan\">\n"
      "<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n{}<g class=\"layer-surfaces\">\n{}</g>\n<g class=\"layer-way\">\n{}</g>\n"
      "<g class=\"layer-rooms\">\n{}</g>\n<g class=\"layer-surfaces\">\n{}</g>\n{}</svg></figure>\n",
      EscapeXml(plan.storeys[storey.index()].name), Decimal(sheet.width()), Decimal(sheet.height()), DrawFloorPlan(plan, storey, sheet),
      DrawSurfaces(plan, storey, deviations, limit_m, sheet) + DrawUnplanned(plan, storey, deviations, sheet),
      DrawTrajectory(plan, storey, run, sheet) + (open ? DrawPlaces(plan, storey, *open, sheet) : ""), DrawRoomLabels(plan, storey, sheet),
      DrawWallNumbers(plan, storey, rows, sheet) + DrawDoorways(plan, storey, deviations, sheet),
      DrawScaleBar(sheet, 30, sheet.height() - 45));
}

// Storeys that the robot was or may be on; all of them where nothing is known.
std::set<StoreyId> VisitedStoreys(const AGraph& plan, const Run& run) {
  std::set<StoreyId> visited;
  if (const TryRow* open = OpenTry(run)) {
    for (const HypothesisRow& h : open->hypotheses) visited.insert(StoreyAt(plan, h.position_m.z()));
    if (!visited.empty()) return visited;
  }
  for (const auto& pose : run.smoothed) visited.insert(StoreyAt(plan, pose.T.translation().z()));
  for (size_t i = 0; run.smoothed.empty() && i < plan.storeys.size(); ++i) visited.insert(StoreyId(i));
  return visited;
}

std::string Figures(const AGraph& plan, const Run& run, const std::vector<WallRow>& rows) {
  const double limit_m = ColorLimit(run.deviations);
  std::string out = LegendHtml(limit_m), others;
  const std::set<StoreyId> visited = VisitedStoreys(plan, run);
  for (size_t i = 0; i < plan.storeys.size(); ++i) {
    const StoreyId storey(i);
    const bool has_walls = std::any_of(plan.walls.begin(), plan.walls.end(), [&](const Wall& w) { return w.storey == storey; });
    if (!has_walls) continue;
    if (visited.contains(storey)) {
      out += Figure(plan, storey, run, run.deviations, rows, limit_m);
    } else {
      others += Figure(plan, storey, run, WhereSeen(plan, storey, run.deviations), rows, limit_m);
    }
  }
  if (!others.empty())
    out += fmt::format("<details><summary>{}</summary>\n{}</details>\n",
                       OpenTry(run) ? "Storeys without a place that is left open" : "Storeys that were not visited", others);
  return out;
}

// "into Kitchen", "away from Kitchen": what the sign of the displacement means on the spot.
std::string Sense(const AGraph& plan, const SurfaceEntry& s) {
  const RoomId room = plan.surfaces[s.id.index()].room;
  const std::string side = room.valid() ? EscapeXml(plan.rooms[room.index()].name) : std::string("the outside");
  return fmt::format("{} {}", s.translation_m >= 0 ? "into" : "away from", side);
}

std::string WallRowHtml(const AGraph& plan, const WallRow& row) {
  const Wall& wall = plan.walls[row.wall.index()];
  const SurfaceEntry& s = *row.surface;
  const std::string storey = wall.storey.valid() ? EscapeXml(plan.storeys[wall.storey.index()].name) : "";
  const std::string chip = row.number > 0
                               ? fmt::format("<span class=\"chip\" style=\"background:{}\">{}</span>",
                                             s.status == "missing" ? kMissingColor : DeviationColor(s.translation_m, 0.01), row.number)
                               : "";
  if (s.status == "missing") {
    return fmt::format(
        "<tr class=\"off\"><td class=\"t\">{}</td><td class=\"t\">{}<small>{}</small></td><td class=\"t\">{}</td><td class=\"t\">missing"
        "<small>{:.0f} lines of sight go through</small></td><td></td><td></td><td></td><td>{:.1f}</td><td></td></tr>\n",
        chip, EscapeXml(wall.name), EscapeXml(s.wall_guid), storey, s.points, s.observed_m2);
  }
  return fmt::format(
      "<tr{}><td class=\"t\">{}</td><td class=\"t\">{}<small>{}</small></td><td class=\"t\">{}</td><td class=\"t\">{}</td>"
      "<td>{} &plusmn; {:.1f}<small>{}</small></td><td>{} &plusmn; {:.2f}</td><td>{:.3f}</td><td>{:.1f}</td><td>{:.0f}</td></tr>\n",
      row.number > 0 ? " class=\"off\"" : "", chip, EscapeXml(wall.name), EscapeXml(s.wall_guid), storey, StatusText(s.status),
      Signed(100 * s.translation_m, 1), 100 * s.sigma_translation_m, row.number > 0 ? Sense(plan, s) : "", Signed(s.rotation_deg, 2),
      s.sigma_rotation_deg, s.p_deviated, s.observed_m2, s.points);
}

// Why a wall is not judged of which something was seen.
const char* UnjudgedText(const std::string& why) {
  const std::pair<const char*, const char*> texts[] = {{"seen_too_little", "too little of it was seen"},
                                                       {"uncertain", "by what was seen it may be far off"},
                                                       {"undecided", "probably off, but not surely"},
                                                       {"may_be_furniture", "what was seen may be furniture"},
                                                       {"other_shape", "what was seen is another shape of the plan"},
                                                       {"no_covariance", "nothing tells how sure the estimate is"},
                                                       {"planar_laser", "a planar laser sees furniture alike"}};
  for (const auto& [name, text] : texts) {
    if (why == name) return text;
  }
  return "";
}

// Without its estimate: what the prior makes of such a wall would pass for a finding.
std::string UnjudgedRowHtml(const AGraph& plan, const WallRow& row) {
  const Wall& wall = plan.walls[row.wall.index()];
  const SurfaceEntry& s = *row.surface;
  return fmt::format(
      "<tr><td></td><td class=\"t\">{}<small>{}</small></td><td class=\"t\">{}</td><td class=\"t\">not judged<small>{}</small></td>"
      "<td></td><td></td><td></td><td>{:.1f}</td><td>{:.0f}</td></tr>\n",
      EscapeXml(wall.name), EscapeXml(s.wall_guid), wall.storey.valid() ? EscapeXml(plan.storeys[wall.storey.index()].name) : "",
      UnjudgedText(s.unjudged), s.observed_m2, s.points);
}

std::string WallTable(const AGraph& plan, const std::vector<WallRow>& rows) {
  std::string body;
  size_t unobserved = 0;
  for (const WallRow& row : rows) {
    if (row.surface->status == "unobserved") {
      ++unobserved;
      if (row.surface->points > 0) body += UnjudgedRowHtml(plan, row);
    } else {
      body += WallRowHtml(plan, row);
    }
  }
  const std::string rest =
      unobserved == 0
          ? ""
          : fmt::format("<p class=\"note\">Walls that were not observed well enough to judge: {} of {}.</p>\n", unobserved, rows.size());
  if (body.empty()) return "<h2>Walls</h2>\n" + rest;
  return fmt::format(
      "<h2>Walls</h2>\n<div class=\"scroll\"><table><thead><tr><th class=\"t\"></th><th class=\"t\">wall</th><th "
      "class=\"t\">storey</th><th class=\"t\">"
      "verdict</th><th>displacement &plusmn; &sigma;, cm</th><th>turn &plusmn; &sigma;, &deg;</th><th>P(deviated)</th><th>seen, "
      "m&sup2;</th><th>points</th>"
      "</tr></thead><tbody>\n{}</tbody></table></div>\n{}",
      body, rest);
}

std::string UnplannedTable(const AGraph& plan, const Deviations& deviations) {
  std::string body;
  for (const UnplannedEntry& wall : deviations.unplanned) {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double longest_m = 0;
    for (size_t i = 0; i < wall.polygon.size(); ++i) {
      middle += wall.polygon[i] / static_cast<double>(wall.polygon.size());
      longest_m = std::max(longest_m, (wall.polygon[(i + 1) % wall.polygon.size()] - wall.polygon[i]).norm());
    }
    const Room* room = wall.room.valid() ? &plan.rooms[wall.room.index()] : nullptr;
    fmt::format_to(
        std::back_inserter(body),
        "<tr class=\"off\"><td class=\"t\">{}</td><td class=\"t\">{}</td><td>{:.2f}, {:.2f}</td><td>{:.2f}</td><td>{:.2f}</td></tr>\n",
        room ? EscapeXml(room->name) : "", room && room->storey.valid() ? EscapeXml(plan.storeys[room->storey.index()].name) : "",
        middle.x(), middle.y(), longest_m, wall.height_m);
  }
  if (body.empty()) return {};
  return fmt::format(
      "<h2>Walls in no plan</h2>\n<div class=\"scroll\"><table><thead><tr><th class=\"t\">in room</th><th "
      "class=\"t\">storey</th><th>middle x, y, m</th>"
      "<th>length, m</th><th>seen up to, m</th></tr></thead><tbody>\n{}</tbody></table></div>\n",
      body);
}

std::string RoomTable(const AGraph& plan, const Deviations& deviations) {
  std::string body;
  for (const RoomEntry& r : deviations.rooms) {
    if (r.status == "unobserved") continue;
    const Room& room = plan.rooms[r.id.index()];
    fmt::format_to(
        std::back_inserter(body),
        "<tr{}><td class=\"t\">{}</td><td class=\"t\">{}</td><td class=\"t\">{}</td><td>{:.2f}</td><td>{}, {}</td><td>{:.1f}</td>"
        "<td>{}</td></tr>\n",
        r.status == "as_planned" ? "" : " class=\"off\"", EscapeXml(room.name),
        room.storey.valid() ? EscapeXml(plan.storeys[room.storey.index()].name) : "", StatusText(r.status), room.area_m2,
        Signed(100 * r.translation_m.x(), 1), Signed(100 * r.translation_m.y(), 1), 100 * r.sigma_m, Signed(r.rotation_deg, 2));
  }
  if (body.empty()) return {};
  return fmt::format(
      "<h2>Rooms</h2>\n<div class=\"scroll\"><table><thead><tr><th class=\"t\">room</th><th class=\"t\">storey</th><th "
      "class=\"t\">verdict</th>"
      "<th>planned area, m&sup2;</th><th>moved x, y, cm</th><th>&sigma;, cm</th><th>turn, "
      "&deg;</th></tr></thead><tbody>\n{}</tbody></table></div>\n",
      body);
}

std::string Footer(const RunInfo& info) {
  std::string options;
  for (const Option& o : info.options) {
    if (!o.value.empty()) fmt::format_to(std::back_inserter(options), "{}{} = {}", options.empty() ? "" : ", ", o.name, o.value);
  }
  return fmt::format(
      "<footer><dl><dt>plan</dt><dd>{}</dd><dt>drawn in</dt><dd>{}</dd><dt>SHA-256 of the "
      "drawing</dt><dd>{}</dd><dt>recording</dt><dd>{}</dd>"
      "<dt>options</dt><dd>{}</dd><dt>made by</dt><dd>plumb {}</dd></dl></footer>\n",
      EscapeXml(info.plan_path), EscapeXml(info.plan_source), EscapeXml(info.plan_source_sha256), EscapeXml(info.recording_path),
      EscapeXml(options), EscapeXml(info.plumb_version));
}

std::string CheckIds(const AGraph& plan, const Deviations& deviations) {
  for (const SurfaceEntry& s : deviations.surfaces) {
    if (s.id.index() >= plan.surfaces.size()) return fmt::format("surface {}", s.id.value);
  }
  for (const RoomEntry& r : deviations.rooms) {
    if (r.id.index() >= plan.rooms.size()) return fmt::format("room {}", r.id.value);
  }
  for (const DoorwayEntry& d : deviations.doorways) {
    if (d.id.index() >= plan.doorways.size()) return fmt::format("doorway {}", d.id.value);
  }
  for (const UnplannedEntry& w : deviations.unplanned) {
    if (w.room.valid() && w.room.index() >= plan.rooms.size()) return fmt::format("room {}", w.room.value);
  }
  return {};
}

}  // namespace

Expected<std::string> RunToHtml(const AGraph& plan, const Run& run, const RunInfo& info) {
  if (const std::string id = CheckIds(plan, run.deviations); !id.empty()) {
    return Fail(ErrorCode::kBadRunFolder,
                fmt::format("the run's deviations name {}, which the plan does not have: it was made with another plan", id));
  }
  const std::vector<WallRow> rows = WallRows(plan, run.deviations);
  const std::string title = EscapeXml(SourceFileNames(info.plan_source));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>{0} as built</title>\n<style>\n{1}{2}{3}{4}</style></head>\n<body>\n<h1>{0}: as built against the plan</h1>\n"
      "<p class=\"sub\">where the robot was, and how far each wall stands from where the plan has "
      "it</p>\n{5}{6}<h2>Plan</h2>\n{7}{8}{9}{10}"
      "<script>\n{11}</script>\n</body></html>\n",
      title, FloorPlanStyle(), DeviationStyle() + DoorwayStyle(), TrajectoryStyle() + PlaceStyle(), PageStyle(),
      Tiles(info, run.deviations, rows), Notes(info, run.deviations),
      Figures(plan, run, rows) + (OpenTry(run) ? PlacesHtml(*OpenTry(run)) : ""),
      WallTable(plan, rows) + DoorwayTable(plan, run.deviations) + UnplannedTable(plan, run.deviations), RoomTable(plan, run.deviations),
      Footer(info), PageScript());
}

}  // namespace plumb::tools
