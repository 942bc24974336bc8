#include "tools/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/house.h"
#include "tools/drawing/floor_plan.h"
#include "tools/report/deviation_overlay.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A run in the house: localized after 2 s; the wall between A and C is 20 cm off and turned, the one across 9 cm the other way.
Run MakeRun(const AGraph& house) {
  tools::Run run;
  for (int i = 0; i < 300; ++i) {
    const double t = 0.1 * i;
    run.verdicts.push_back({t, i < 20 ? "searching" : "localized", i < 20 ? 0 : 1});
    runtime::StampedPose pose;
    pose.stamp_s = t;
    pose.T.translation() << 1.0 + 0.023 * i, 2.75 + 0.6 * std::sin(0.05 * i), 0.6;
    run.smoothed.push_back(pose);
    if (i >= 20) run.online.push_back(pose);
  }
  run.deviations.gauge = "fewest walls deviate";
  for (size_t i = 0; i < house.surfaces.size(); ++i) {
    const Surface& surface = house.surfaces[i];
    SurfaceEntry s;
    s.id = SurfaceId(i);
    s.wall_guid = house.walls[surface.wall.index()].guid;
    s.status = surface.room.valid() ? "as_planned" : "unobserved";
    s.points = 1000;
    s.sigma_translation_m = 0.004;
    const double sign = surface.normal.x() + surface.normal.y() > 0 ? 1 : -1;
    if (s.wall_guid == "wall-middle") s.status = "deviated", s.translation_m = sign * 0.203, s.rotation_deg = 2.1, s.p_deviated = 0.999;
    if (s.wall_guid == "wall-across") s.status = "deviated", s.translation_m = -sign * 0.09, s.p_deviated = 0.99;
    run.deviations.surfaces.push_back(s);
  }
  for (size_t i = 0; i < house.rooms.size(); ++i) {
    RoomEntry room;
    room.id = RoomId(i);
    room.status = i == 2 ? "as_planned" : "deviated";
    room.translation_m = {0.1, 0.0};
    run.deviations.rooms.push_back(room);
  }
  return run;
}

RunInfo MakeInfo() {
  RunInfo info;
  info.plan_source = "plans/house.ifc";
  info.scans = 300;
  info.localized_scans = 280;
  info.time_to_localize_s = 2.0;
  return info;
}

TEST(Report, IsOnePageThatNeedsNothingElse) {
  const AGraph house = test::MakeHouse();
  const auto html = RunToHtml(house, MakeRun(house), MakeInfo());
  ASSERT_TRUE(html) << html.error().message;
  for (const char* part : {"src=", "href=", "@import", "http:", "https:"}) EXPECT_THAT(*html, Not(HasSubstr(part))) << part;
  EXPECT_THAT(*html, HasSubstr("<title>house.ifc as built</title>"));
  EXPECT_THAT(*html, HasSubstr("<b>2.0 s</b>"));
  EXPECT_THAT(*html, HasSubstr("<b>2 of 6</b><span>observed walls deviate"));
  EXPECT_THAT(*html, HasSubstr("20.3 cm</text>"));
  EXPECT_THAT(*html, HasSubstr("fewest walls deviate"));
  EXPECT_EQ(*html, *RunToHtml(house, MakeRun(house), MakeInfo()));
}

TEST(Report, MarksOnOneSpotShareALabel) {
  const AGraph house = test::MakeHouse();
  auto run = MakeRun(house);
  EXPECT_THAT(*RunToHtml(house, run, MakeInfo()), AllOf(HasSubstr(">start</text>"), HasSubstr(">end</text>")));
  run.online.erase(run.online.begin(), run.online.end() - 1);
  EXPECT_THAT(*RunToHtml(house, run, MakeInfo()), AllOf(HasSubstr(">start</text>"), HasSubstr(">first fix, end</text>")));
}

TEST(Report, ShowsWhereARobotThatWasNotFoundCouldBe) {
  const AGraph house = test::MakeHouse();
  tools::Run run = MakeRun(house);
  TryRow attempt;
  attempt.hypotheses.resize(2);
  attempt.hypotheses[0].probability = 0.7;
  attempt.hypotheses[0].position_m = {2, 2, 0.6};
  attempt.hypotheses[1].room_name = "<Küche>";
  attempt.guidance = GuidanceRow{1, std::nullopt};
  run.tries = {TryRow(), attempt};
  const std::string found = *RunToHtml(house, run, MakeInfo());
  EXPECT_THAT(found, Not(HasSubstr("Where it could be")));
  EXPECT_THAT(found, Not(HasSubstr("class=\"mark place\"")));
  run.online.clear();
  run.smoothed.clear();
  for (VerdictRow& v : run.verdicts) v.verdict = "ambiguous";
  const std::string html = *RunToHtml(house, run, MakeInfo());
  EXPECT_THAT(html, HasSubstr("<td>70.0</td>"));
  EXPECT_THAT(html, HasSubstr("&lt;Küche&gt;"));
  EXPECT_THAT(html, HasSubstr("2 places look alike"));
  EXPECT_THAT(html, HasSubstr("class=\"mark place\""));
}

TEST(Report, ListsDeviatedWallsBySize) {
  const AGraph house = test::MakeHouse();
  const tools::Run run = MakeRun(house);
  const auto rows = WallRows(house, run.deviations);
  ASSERT_EQ(rows.size(), house.walls.size());
  EXPECT_EQ(rows[0].surface->wall_guid, "wall-middle");
  EXPECT_EQ(rows[0].number, 1);
  EXPECT_EQ(rows[1].surface->wall_guid, "wall-across");
  EXPECT_EQ(rows[2].number, 0);
}

TEST(Report, SaysWhyAWallThatWasSeenIsNotJudged) {
  const AGraph house = test::MakeHouse();
  tools::Run run = MakeRun(house);
  const char* why = "not judged<small>by what was seen it may be far off</small>";
  EXPECT_THAT(*RunToHtml(house, run, MakeInfo()), Not(HasSubstr("not judged")));
  for (SurfaceEntry& s : run.deviations.surfaces) {
    if (s.wall_guid == "wall-across") s.status = "unobserved", s.unjudged = "uncertain";
  }
  EXPECT_THAT(*RunToHtml(house, run, MakeInfo()), HasSubstr(why));
  for (SurfaceEntry& s : run.deviations.surfaces) {
    if (s.wall_guid == "wall-across") s.points = 0;
  }
  EXPECT_THAT(*RunToHtml(house, run, MakeInfo()), Not(HasSubstr("not judged"))) << "nothing of it was seen";
}

TEST(Report, ShowsMissingWallsAndWallsInNoPlan) {
  const AGraph house = test::MakeHouse();
  tools::Run run = MakeRun(house);
  for (SurfaceEntry& s : run.deviations.surfaces) {
    if (s.wall_guid == "wall-across") s.status = "missing", s.translation_m = 0;
  }
  run.deviations.unplanned = {{{{6, 3}, {7.5, 3}, {7.5, 3.1}, {6, 3.1}}, 2.4, RoomId(2)}};
  const std::string html = RunToHtml(house, run, MakeInfo()).value();
  const Sheet sheet = SheetOf(house, StoreyId(0));
  EXPECT_THAT(html, HasSubstr("<b>1 of 5</b><span>observed walls deviate"));
  EXPECT_THAT(html, HasSubstr("<b>1, 1</b><span>walls missing, walls in no plan"));
  EXPECT_THAT(html, HasSubstr("<path class=\"missing\" d=\"" + sheet.Closed({{0, 3.44}, {4.94, 3.44}, {4.94, 3.56}, {0, 3.56}})));
  EXPECT_THAT(html, HasSubstr("<path class=\"unplanned\" d=\"" + sheet.Closed(run.deviations.unplanned[0].polygon)));
  EXPECT_THAT(html, HasSubstr("<h2>Walls in no plan</h2>"));
  const auto rows = WallRows(house, run.deviations);
  EXPECT_EQ(rows[0].surface->wall_guid, "wall-middle");
  EXPECT_EQ(rows[1].surface->status, "missing");
  EXPECT_EQ(rows[1].number, 2);
  run.deviations.unplanned[0].room = RoomId(9);
  EXPECT_EQ(RunToHtml(house, run, MakeInfo()).error().code, ErrorCode::kBadRunFolder);
}

TEST(Report, TheBuiltSurfaceIsShiftedAlongTheNormalAndTurnedAboutItsMiddle) {
  AGraph house = test::MakeHouse();
  Deviations deviations;
  SurfaceEntry s;
  s.id = house.rooms[0].surfaces[0];  // south wall seen from A: (0,0) to (4.94,0), normal +y
  s.status = "deviated";
  s.translation_m = 0.10;
  s.rotation_deg = 90;
  deviations.surfaces = {s};
  const Sheet sheet = SheetOf(house, StoreyId(0));
  // Turned by 90 degrees the wall stands upright at its middle: from y = 0.1 - 2.47 to y = 0.1 + 2.47.
  EXPECT_THAT(DrawSurfaces(house, StoreyId(0), deviations, 0.1, sheet),
              HasSubstr("class=\"dev built\" d=\"" + sheet.Line({2.47, -2.37}, {2.47, 2.57}) + "\""));
}

// A wall's verdict is that of all its faces, also of those two storeys up that nobody saw.
TEST(Report, ShowsAWallOfAStoreyThatWasNotVisitedAsJudgedOnlyWhereItWasSeen) {
  AGraph house = test::MakeHouse();
  tools::Run run = MakeRun(house);
  house.storeys.push_back({"storey-1", "Attic", 6.0, 2.5});
  house.walls.push_back(house.walls[0]);
  house.walls.back().storey = StoreyId(1);
  Surface face = house.surfaces[0];
  face.storey = StoreyId(1);
  face.z_min_m += 6;
  face.z_max_m += 6;
  house.surfaces.push_back(face);
  SurfaceEntry entry = run.deviations.surfaces[0];
  entry.id = SurfaceId(house.surfaces.size() - 1);
  entry.status = "as_planned";
  const auto attic = [&](double points) {
    entry.points = points;
    tools::Run with = run;
    with.deviations.surfaces.push_back(entry);
    const std::string html = *RunToHtml(house, with, MakeInfo());
    return html.substr(html.find("Storeys that were not visited"));
  };
  EXPECT_THAT(attic(0), Not(HasSubstr("class=\"as-planned\"")));
  EXPECT_THAT(attic(500), HasSubstr("class=\"as-planned\""));
}

TEST(Report, SaysWhenNothingWasFound) {
  const AGraph house = test::MakeHouse();
  tools::Run run;
  run.verdicts = {{0, "searching", 0}};
  RunInfo info = MakeInfo();
  info.time_to_localize_s.reset();
  info.last_reason = "too few walls seen";
  const auto html = RunToHtml(house, run, info);
  ASSERT_TRUE(html);
  EXPECT_THAT(*html, HasSubstr("was not localized in this plan: too few walls seen"));
}

TEST(Report, WarnsWhereTheRunIsWorthLess) {
  RunInfo info = MakeInfo();
  const AGraph house = test::MakeHouse();
  EXPECT_EQ(RunToHtml(house, MakeRun(house), info).value().find("note bad"), std::string::npos);
  info.untimed_scans = 7;
  info.unreadable_scans = 3;
  info.interrupted = true;
  const std::string html = RunToHtml(house, MakeRun(house), info).value();
  EXPECT_NE(html.find("7 of "), std::string::npos);
  EXPECT_NE(html.find("3 scans could not be read"), std::string::npos);
  EXPECT_NE(html.find("interrupted"), std::string::npos);
}

TEST(Report, RefusesARunOfAnotherPlan) {
  const AGraph house = test::MakeHouse();
  tools::Run run = MakeRun(house);
  run.deviations.surfaces.back().id = SurfaceId(99);
  const auto html = RunToHtml(house, run, MakeInfo());
  ASSERT_FALSE(html);
  EXPECT_EQ(html.error().code, ErrorCode::kBadRunFolder);
  EXPECT_THAT(html.error().message, HasSubstr("surface 99"));
}

}  // namespace
}  // namespace plumb::tools
