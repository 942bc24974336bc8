#include "tools/inspect/graphml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

using ::testing::HasSubstr;

std::vector<std::smatch> Matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), regex), std::sregex_iterator()};
}

TEST(GraphMl, HasANodeForEachRoomDoorwayAndSurface) {
  const AGraph house = test::MakeHouse();
  const std::string text = AGraphToGraphMl(house);
  std::set<std::string> nodes;
  for (const auto& m : Matches(text, "<node id=\"([^\"]*)\"")) EXPECT_TRUE(nodes.insert(m[1]).second) << m[1];
  EXPECT_EQ(nodes.size(), house.rooms.size() + house.doorways.size() + house.surfaces.size() + 1);
  EXPECT_TRUE(nodes.contains("outside"));
  // Every edge has its ends, every key that is used is declared.
  for (const auto& m : Matches(text, "source=\"([^\"]*)\" target=\"([^\"]*)\""))
    EXPECT_TRUE(nodes.contains(m[1]) && nodes.contains(m[2])) << m[0];
  for (const auto& m : Matches(text, "<data key=\"([^\"]*)\"")) EXPECT_THAT(text, HasSubstr("<key id=\"" + m[1].str() + "\""));
}

TEST(GraphMl, DoorwaysJoinRoomsAndSurfacesBoundThem) {
  AGraph house = test::MakeHouse();
  house.open_boundaries.push_back({StoreyId(0), RoomId(0), RoomId(1), {1, 3.5}, {2, 3.5}});
  house.factors.push_back({FactorKind::kWallSurfaces, {4, 1, 11}});
  const std::string text = AGraphToGraphMl(house);
  EXPECT_THAT(text, HasSubstr("source=\"doorway:0\" target=\"room:0\"><data key=\"edge_kind\">joins<"));
  EXPECT_THAT(text, HasSubstr("source=\"doorway:2\" target=\"outside\"><data key=\"edge_kind\">joins<"));
  EXPECT_THAT(text, HasSubstr("source=\"room:0\" target=\"room:1\"><data key=\"edge_kind\">open<"));
  EXPECT_THAT(text, HasSubstr("source=\"surface:1\" target=\"surface:11\"><data key=\"edge_kind\">same wall<"));
  EXPECT_EQ(Matches(text, ">bounds<").size(), 12u);  // those of the outside bound no room
}

TEST(GraphMl, EscapesNames) {
  AGraph house = test::MakeHouse();
  house.rooms[0].name = "a<b>&\"c\"\x02";
  EXPECT_THAT(AGraphToGraphMl(house), HasSubstr("<data key=\"label\">a&lt;b&gt;&amp;&quot;c&quot;</data>"));
}

TEST(GraphMl, OfAnEmptyPlanIsAnEmptyGraph) {
  const std::string text = AGraphToGraphMl(AGraph{});
  EXPECT_EQ(Matches(text, "<node ").size(), 0u);
  EXPECT_THAT(text, ::testing::EndsWith("</graphml>\n"));
}

}  // namespace
}  // namespace plumb::tools
