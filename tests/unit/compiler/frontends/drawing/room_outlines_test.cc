#include "compiler/frontends/drawing/room_outlines.h"

#include <gtest/gtest.h>

#include "compiler/frontends/drawing/plane.h"
#include "tests/unit/compiler/frontends/drawing/draw.h"

namespace plumb::compiler {
namespace {

using test::AddBox;

void AddText(const std::string& text, double x, double y, Drawing& drawing) {
  DrawnText t;
  t.text = text;
  t.at = {x, y};
  t.height_m = 0.2;
  drawing.texts.push_back(t);
}

// Three offices side by side, 4 m by 5 m each.
Drawing Offices() {
  Drawing out;
  for (int i = 0; i < 3; ++i) {
    AddBox(5 * i, 0, 5 * i + 4, 5, out);
    AddText("Office", 5 * i + 2, 2.5, out);
  }
  return out;
}

// By the paths that they come from.
std::vector<std::string> RoomsOf(Drawing drawing) {
  AddOutlinedRooms(drawing);
  std::vector<std::string> out;
  for (const DrawnSpace& space : drawing.spaces) out.push_back(space.location.guid);
  for (const DrawnPath& path : drawing.paths) EXPECT_EQ(path.outlines_room, std::count(out.begin(), out.end(), path.location.guid) > 0);
  return out;
}

using Guids = std::vector<std::string>;

TEST(OutlinedRooms, AreTheOutlinesAroundNames) {
  Drawing drawing = Offices();
  AddBox(20, 0, 24, 5, drawing);  // without a name
  EXPECT_EQ(RoomsOf(drawing), (Guids{"0", "1", "2"}));
}

TEST(OutlinedRooms, FewerThanThreeAreFramesAroundTitles) {
  Drawing drawing = Offices();
  drawing.texts.pop_back();
  EXPECT_TRUE(RoomsOf(drawing).empty());
}

TEST(OutlinedRooms, TheFrameAroundThemIsNone) {
  Drawing drawing = Offices();
  AddBox(-1, -1, 15, 6, drawing);
  AddText("Ground floor", 4.5, 5.5, drawing);  // beside the rooms, in the frame alone
  EXPECT_EQ(RoomsOf(drawing), (Guids{"0", "1", "2"}));
}

TEST(OutlinedRooms, OneThatHoldsLittleElseIsARoom) {
  Drawing drawing = Offices();
  AddBox(20, 0, 40, 20, drawing);  // a hall with a kiosk in it
  AddText("Hall", 30, 15, drawing);
  AddBox(22, 2, 25, 5, drawing);
  AddText("Kiosk", 23.5, 3.5, drawing);
  EXPECT_EQ(RoomsOf(drawing), (Guids{"0", "1", "2", "3", "4"}));
}

TEST(OutlinedRooms, TagsInARoomAreNoneButClosetsBesideRoomsAre) {
  Drawing drawing = Offices();
  AddBox(1.5, 2.2, 2.5, 2.8, drawing);  // around the first office's name
  AddBox(20, 0, 21, 1, drawing);
  AddText("Closet", 20.5, 0.5, drawing);
  AddBox(22, 0, 22.4, 0.4, drawing);  // too small for either
  AddText("Shaft", 22.2, 0.2, drawing);
  EXPECT_EQ(RoomsOf(drawing), (Guids{"0", "1", "2", "4"}));
}

TEST(OutlinedRooms, WallsAndOpenLinesOutlineNone) {
  Drawing drawing = Offices();
  drawing.paths[0].role = LineRole::kWall;
  drawing.paths[1].closed = false;
  EXPECT_TRUE(RoomsOf(drawing).empty());
}

}  // namespace
}  // namespace plumb::compiler
