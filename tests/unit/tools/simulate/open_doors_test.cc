#include "tools/simulate/open_doors.h"

#include <gtest/gtest.h>

#include "tests/support/house.h"

namespace plumb::tools {
namespace {

size_t CountTriangles(const AGraph& house, const std::string& guid) {
  size_t count = 0;
  for (const Triangle& t : house.mesh.triangles) count += house.elements[t.element].guid == guid ? 1 : 0;
  return count;
}

uint32_t AddDoorElement(AGraph& house, const std::string& guid) {
  Element door;
  door.guid = guid;
  door.kind = ElementKind::kDoor;
  door.storey = StoreyId(0);
  door.wall = house.doorways[1].wall;
  door.doorway = DoorwayId(1);
  house.elements.push_back(door);
  return static_cast<uint32_t>(house.elements.size() - 1);
}

TEST(OpenDoors, TakesOutTheLeafAndKeepsTheFrame) {
  // D2 in the middle wall at x = 5, y from 2.3 to 3.2: one element with a leaf and two posts.
  AGraph house = test::MakeHouse();
  const uint32_t door = AddDoorElement(house, "door-D2");
  test::AddBox(house, {4.98, 2.36, 0.01}, {5.02, 3.14, 2.05}, door);
  test::AddBox(house, {4.94, 2.30, 0}, {5.06, 2.35, 2.1}, door);
  test::AddBox(house, {4.94, 3.15, 0}, {5.06, 3.20, 2.1}, door);
  const AGraph open = WithInnerDoorsOpen(house);
  EXPECT_EQ(CountTriangles(house, "door-D2"), 36u);
  EXPECT_EQ(CountTriangles(open, "door-D2"), 24u);
  EXPECT_EQ(CountTriangles(open, "leaf-D3"), 12u);  // the door to the outside stays shut
  EXPECT_EQ(house.mesh.triangles.size() - open.mesh.triangles.size(), 12u);
}

TEST(OpenDoors, TakesOutARailAtTheBottomAndKeepsAThreshold) {
  AGraph house = test::MakeHouse();
  test::AddBox(house, {4.98, 2.36, 0.0}, {5.02, 3.14, 0.101}, AddDoorElement(house, "rail"));
  test::AddBox(house, {4.97, 2.37, 0.0}, {5.03, 3.13, 0.03}, AddDoorElement(house, "threshold"));
  const AGraph open = WithInnerDoorsOpen(house);
  EXPECT_EQ(CountTriangles(open, "rail"), 0u);
  EXPECT_EQ(CountTriangles(open, "threshold"), 12u);
}

TEST(OpenDoors, TakesOutADoorThatIsOnePiece) {
  AGraph house = test::MakeHouse();
  test::AddBox(house, {4.94, 2.30, 0}, {5.06, 3.20, 2.1}, AddDoorElement(house, "door-D2"));
  EXPECT_EQ(CountTriangles(WithInnerDoorsOpen(house), "door-D2"), 0u);
}

}  // namespace
}  // namespace plumb::tools
