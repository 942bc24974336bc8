#include "runtime/deviations/displaced_wall.h"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>

namespace plumb::runtime {
namespace {

constexpr double kDeg = std::numbers::pi / 180;

// 3 m along y about the origin, 10 cm thick, 2 m high, solid all over.
FaceGrid MakeWall() {
  FaceGrid g;
  g.wall = WallId(0);
  g.half_m = 0.05;
  g.cell_m = 0.25;
  g.panel.start = {0, -1.5};
  g.panel.along = Eigen::Vector2d::UnitY();
  g.panel.normal = Eigen::Vector2d::UnitX();
  g.panel.length_m = 3;
  g.panel.z_max_m = g.z_high_m = 2;
  g.columns = 12;
  g.rows = 8;
  g.cells.assign(96, {.solid = true});
  return g;
}

// The wall as built: its middle plane is met at `from` + t (`to` - `from`).
struct Built {
  double offset_m = 0, yaw_rad = 0;
  [[nodiscard]] std::optional<double> Meets(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    const Eigen::Vector2d normal(std::cos(yaw_rad), std::sin(yaw_rad)), pivot(offset_m, 0);
    const double before = normal.dot(from.head<2>() - pivot), behind = normal.dot(to.head<2>() - pivot);
    if (before * behind >= 0) return {};
    const double t = before / (before - behind);
    const Eigen::Vector2d at = (from + t * (to - from)).head<2>() - pivot;
    if (std::abs(normal.x() * at.y() - normal.y() * at.x()) > 1.5) return {};
    return t;
  }
};

// From five places on either side to a grid of points on the other.
bool MayStand(const std::optional<Built>& built, double reach_m) {
  WallFrame frame;
  frame.reference = SurfaceId(0);
  DisplacedWall wall(frame, {MakeWall()}, {});
  for (uint32_t keyframe = 0; keyframe < 10; ++keyframe) {
    const double side = keyframe % 2 == 0 ? 1 : -1;
    const Eigen::Vector3d from(3 * side, 0.6 * (keyframe / 2) - 1.2, 1.0);
    for (double y = -3; y <= 3; y += 0.1) {
      for (double z = 0; z <= 2; z += 0.1) {
        const Eigen::Vector3d to(-reach_m * side, y, z);
        const std::optional<double> stop = built ? built->Meets(from, to) : std::nullopt;
        wall.Count({from, stop ? Eigen::Vector3d(from + *stop * (to - from)) : to, keyframe}, true);
      }
    }
  }
  return wall.MayStand();
}

TEST(DisplacedWall, StandsNowhereInWhatIsSeenThrough) { EXPECT_FALSE(MayStand({}, 3)); }

TEST(DisplacedWall, StandsOffAndTurnedBetweenThePlacesTried) {
  EXPECT_TRUE(MayStand(Built{0.47, -25 * kDeg}, 3));
  EXPECT_TRUE(MayStand(Built{-0.58, 29 * kDeg}, 3));
  EXPECT_TRUE(MayStand(Built{0.25, 11 * kDeg}, 3));
  EXPECT_FALSE(MayStand(Built{2.0, 0}, 3));
}

TEST(DisplacedWall, MayStandWhereNothingWasSeen) { EXPECT_TRUE(MayStand({}, -1)); }

}  // namespace
}  // namespace plumb::runtime
