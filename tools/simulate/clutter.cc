#include "tools/simulate/clutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "tools/simulate/box.h"
#include "tools/simulate/random.h"

namespace plumb::tools {
namespace {

constexpr int kTriesPerBox = 10;

Box DrawBox(const FreeSpace& space, const RoomFloor& floor, Random& random) {
  const double angle_rad = random.Uniform(0, std::numbers::pi);
  Box box;
  box.footprint = {space.Center(space.At(floor.cells[random.Index(floor.cells.size())])),
                   {std::cos(angle_rad), std::sin(angle_rad)},
                   random.Uniform(0.15, 0.5),
                   random.Uniform(0.15, 0.4)};
  box.z_min_m = space.floor_z_m();
  box.z_max_m = box.z_min_m + random.Uniform(0.4, 1.8);
  return box;
}

}  // namespace

int AddClutter(AsBuilt& built, StoreyId storey, int boxes, uint64_t seed) {
  Random random(seed, static_cast<uint64_t>(RandomStream::kClutter));
  int placed = 0;
  FreeSpace space(built.house, storey, built.passages);
  const Reach before = FindReach(built.house, storey, space);
  for (int i = 0; i < boxes * kTriesPerBox && placed < boxes; ++i) {
    const RoomFloor& floor = before.rooms[random.Index(before.rooms.size())];
    if (!floor.reachable) continue;
    const Box box = DrawBox(space, floor, random);
    FreeSpace with_box = space;
    with_box.Block(box.footprint);
    // Boxes only ever take ways away: whoever reached fewer rooms before does now.
    if (ReachWithRadius(built.house, storey, with_box, before.robot_radius_m).reachable() < before.reachable()) continue;
    space = std::move(with_box);
    Element element;
    element.name = fmt::format("box {}", placed + 1);
    element.kind = ElementKind::kFurniture;
    element.storey = storey;
    built.house.elements.push_back(element);
    AddBox(built.house, box, static_cast<uint32_t>(built.house.elements.size() - 1));
    ++placed;
  }
  return placed;
}

}  // namespace plumb::tools
