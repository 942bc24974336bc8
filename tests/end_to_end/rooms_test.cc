// The rooms of a real house, from a simulated tour through it to sgraph.json.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/support/program.h"
#include "tests/support/room_overlap.h"

namespace plumb {
namespace {

using Json = nlohmann::json;

// Rooms that the plan parts by a line and no wall: nothing tells a robot where one ends.
std::set<int> PartsOfOpenPlans(const Json& plan) {
  std::set<int> parts;
  for (const Json& boundary : plan.at("open_boundaries")) {
    for (const Json& room : boundary.at("rooms")) parts.insert(room.get<int>());
  }
  return parts;
}

TEST(Rooms, OfTheFzkHouseAreThoseOfItsPlan) {
  const std::string source = test::SharedPlan("ifc/AC20-FZK-Haus.ifc");
  if (!std::filesystem::exists(source)) GTEST_SKIP() << source << " is not there";
  const test::ProgramFolder folder("rooms");
  ASSERT_EQ(folder.Plumb("compile '" + source + "' -o plan.agraph 2> compile.txt"), 0);
  ASSERT_EQ(folder.Plumb("inspect plan.agraph --json > plan.json"), 0);
  ASSERT_EQ(folder.Plumb("simulate plan.agraph --seed 1 --deviate 0 --sensor vlp16 --duration 120 -o rec/"), 0);
  ASSERT_EQ(folder.Plumb("localize plan.agraph rec/ -o run/"), 0);
  const Json plan = folder.Json("plan.json"), sgraph = folder.Json("run/sgraph.json"), truth = folder.Json("rec/truth.json");
  const int storey = truth.at("storey").get<int>();
  const std::set<int> open = PartsOfOpenPlans(plan);
  int rooms = 0, doorways = 0;
  for (const Json& room : plan.at("rooms")) {
    if (room.at("storey") != storey || open.contains(room.at("id").get<int>())) continue;
    const test::Ring2 ring = test::RingOf(room.at("polygon"));
    const auto stood_in = [&](const Json& keyframe) { return plumb::Contains(ring, test::PointOf(keyframe.at("position"))); };
    if (std::none_of(sgraph.at("keyframes").begin(), sgraph.at("keyframes").end(), stood_in)) continue;
    ++rooms;
    EXPECT_GT(test::BestOverlap(ring, sgraph.at("rooms")), 0.8) << room.at("name");
    // The doors between this room and others are open: in the simulation those within the house are.
    for (const Json& planned : plan.at("doorways")) {
      const Json& between = planned.at("rooms");
      if (between.at(0).is_null() || between.at(1).is_null() || (between.at(0) != room.at("id") && between.at(1) != room.at("id")))
        continue;
      ++doorways;
      const auto near = [&](const Json& d) {
        return (test::PointOf(d.at("position")) - test::PointOf(planned.at("position"))).norm() < 0.1;
      };
      EXPECT_TRUE(std::any_of(sgraph.at("doorways").begin(), sgraph.at("doorways").end(), near)) << planned.at("id");
    }
  }
  EXPECT_GE(rooms, 2);
  EXPECT_GE(doorways, 2);
}

}  // namespace
}  // namespace plumb
