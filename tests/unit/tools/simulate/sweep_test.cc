#include "tools/simulate/sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/house.h"
#include "tools/simulate/surface_counter.h"

namespace plumb::tools {
namespace {

SensorModel Ideal() {
  SensorModel model = *FindSensor("vlp16");
  model.noise_m = model.dropout = model.grazing_cos = 0;
  return model;
}

Eigen::Isometry3d At(double x, double y) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.6)); }

// The point of a sweep nearest to straight ahead on the beam one degree up; ring 8 of the VLP-16.
size_t Ahead(const runtime::Scan& scan) {
  size_t best = scan.points.size();
  for (size_t i = 0; i < scan.points.size(); ++i) {
    if (scan.ring[i] != 8 || scan.points[i].x() < 0) continue;
    const auto off = [&](size_t k) { return std::abs(std::atan2(scan.points[k].y(), scan.points[k].x())); };
    if (best == scan.points.size() || off(i) < off(best)) best = i;
  }
  return best;
}

TEST(Sensors, AreWhatTheirMakersSay) {
  const SensorModel vlp16 = *FindSensor("vlp16");
  ASSERT_EQ(vlp16.beams.size(), 16u);
  for (const Beam& beam : vlp16.beams) EXPECT_NEAR(beam.elevation_rad, (-15 + 2 * beam.ring) * std::numbers::pi / 180, 1e-12);
  EXPECT_EQ(vlp16.beams[1].ring, 8);  // fires 1 degree up right after 15 down
  EXPECT_LT(vlp16.beams.back().delay_s, vlp16.period_s() / vlp16.azimuth_steps);
  for (const std::string& name : SensorNames()) EXPECT_EQ(FindSensor(name)->name, name);
  EXPECT_FALSE(FindSensor("sick"));
}

TEST(Lidar, APlanarOneSeesOneLineAndNothingBehind) {
  const AGraph house = test::MakeHouse();
  const Lidar lidar(house, *FindSensor("planar"), 0.9);
  Random random(1);
  const Sweep sweep = lidar.Take(0, 50, [](double) { return At(2, 1.5); }, random);
  EXPECT_GT(sweep.scan.points.size(), 500u);
  for (const Eigen::Vector3f& p : sweep.scan.points) {
    EXPECT_EQ(p.z(), 0);
    EXPECT_LE(std::abs(std::atan2(p.y(), p.x())), 0.751f * static_cast<float>(std::numbers::pi));
  }
}

TEST(Lidar, MeasuresTheRangeToAWall) {
  const AGraph house = test::MakeHouse();
  const Lidar lidar(house, Ideal(), 0.9);
  Random random(1);
  const Sweep sweep = lidar.Take(0, 50, [](double) { return At(2, 1.5); }, random);
  EXPECT_EQ(sweep.scan.points.size(), 28800u);
  EXPECT_EQ(sweep.scan.stamp_s, 50);
  const size_t i = Ahead(sweep.scan);
  // From x = 2 to the middle wall's face at x = 4.94, one degree up.
  EXPECT_NEAR(sweep.scan.points[i].x(), 2.94, 1e-4);
  EXPECT_NEAR(sweep.scan.points[i].norm(), 2.94 / std::cos(std::numbers::pi / 180), 1e-4);
  EXPECT_NEAR(sweep.scan.time_s[i], 0.05, 1e-4);  // the sweep begins behind
  EXPECT_TRUE(std::is_sorted(sweep.scan.time_s.begin(), sweep.scan.time_s.end()));
  EXPECT_LT(sweep.scan.time_s.back(), 0.1f);
}

TEST(Lidar, TurnsClockwiseFromBehind) {
  const AGraph house = test::MakeHouse();
  const Lidar lidar(house, Ideal(), 0.9);
  Random random(1);
  const Sweep sweep = lidar.Take(0, 0, [](double) { return At(2, 1.5); }, random);
  EXPECT_LT(sweep.scan.points[0].x(), 0);
  const Eigen::Vector3f quarter = sweep.scan.points[sweep.scan.points.size() / 4];
  EXPECT_GT(quarter.y(), 0.9f * quarter.head<2>().norm());  // left after a quarter: clockwise seen from above
}

TEST(Lidar, MovesDuringTheSweep) {
  const AGraph house = test::MakeHouse();
  const Lidar lidar(house, Ideal(), 0.9);
  Random random(1);
  // 2 m/s towards the wall; straight ahead is seen half way, 0.05 s after the sweep's start at 0.3 s.
  const Sweep sweep = lidar.Take(0.3, 0.3, [](double t) { return At(1 + 2 * t, 1.5); }, random);
  EXPECT_NEAR(sweep.scan.points[Ahead(sweep.scan)].x(), 4.94 - (1 + 2 * 0.35), 1e-3);
}

TEST(Lidar, AddsNoiseAlongTheRayAndLosesReturns) {
  const AGraph house = test::MakeHouse();
  SensorModel noisy = Ideal();
  noisy.noise_m = 0.02;
  noisy.dropout = 0.1;
  Random random(1), random2(1);
  const auto pose = [](double) { return At(2, 1.5); };
  const Sweep sweep = Lidar(house, noisy, 0.9).Take(0, 0, pose, random);
  EXPECT_NEAR(static_cast<double>(sweep.scan.points.size()), 0.9 * 28800, 250);
  double sum = 0, squares = 0;
  for (size_t i = 0; i < sweep.echoes.size(); ++i) {
    const Eigen::Vector3f exact = sweep.echoes[i].position - Eigen::Vector3f(2, 1.5f, 0.6f);
    const double error = static_cast<double>(sweep.scan.points[i].norm() - exact.norm());
    EXPECT_LT(sweep.scan.points[i].normalized().cross(exact.normalized()).norm(), 1e-4f);
    sum += error;
    squares += error * error;
  }
  const auto n = static_cast<double>(sweep.echoes.size());
  EXPECT_NEAR(sum / n, 0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / n), 0.02, 0.001);
}

TEST(Lidar, SeesThroughPanesAsOftenAsTold) {
  AGraph house = test::MakeHouse();
  Element pane;
  pane.kind = ElementKind::kWindow;
  pane.material = Material::kGlass;
  house.elements.push_back(pane);
  const auto element = static_cast<uint32_t>(house.elements.size() - 1);
  test::AddBox(house, {3.99, 0.01, 0.01}, {4.01, 3.4, 2.59}, element);
  const auto share_on_glass = [&](double transmission) {
    Random random(1);
    const Sweep sweep = Lidar(house, Ideal(), transmission).Take(0, 0, [](double) { return At(2, 1.5); }, random);
    double on_glass = 0, ahead = 0;
    for (size_t i = 0; i < sweep.echoes.size(); ++i) {
      const Eigen::Vector3f p = sweep.scan.points[i];
      if (p.x() < 1.5f || std::abs(p.y() / p.x()) > 0.4f || p.z() < -0.4f) continue;  // rays that pass the pane
      ++ahead;
      if (house.mesh.triangles[sweep.echoes[i].triangle].element == element) ++on_glass;
    }
    EXPECT_GT(ahead, 2000);
    return on_glass / ahead;
  };
  EXPECT_EQ(share_on_glass(1), 0);
  EXPECT_EQ(share_on_glass(0), 1);
  EXPECT_NEAR(share_on_glass(0.9), 0.1, 0.02);  // one chance for both faces of the pane
}

TEST(Lidar, SeesADeviatedWallWhereItWasBuilt) {
  const AGraph plan = test::MakeHouse();
  SimulateOptions options;
  options.seed = 4;
  options.deviate = 2;
  const Expected<AsBuilt> built = BuildWithDeviations(plan, StoreyId(0), options);
  ASSERT_TRUE(built);
  const SurfaceCounter counter(plan, *built);
  const Lidar lidar(built->house, *FindSensor("vlp16"), 0.9);
  std::vector<int> seen(plan.surfaces.size(), 0);
  std::vector<double> sums(plan.surfaces.size(), 0);
  for (const Room& room : plan.rooms) {
    Random random(room.guid.size());
    const Eigen::Isometry3d T = At(room.center.x(), room.center.y());
    const Sweep sweep = lidar.Take(0, 0, [&T](double) { return T; }, random);
    for (size_t i = 0; i < sweep.echoes.size(); ++i) {
      const SurfaceId id = counter.HitOf(sweep.echoes[i]).surface;
      if (!id.valid()) continue;
      const Surface& s = plan.surfaces[id.index()];
      // The built plane, from the displacement as it is written to truth.json.
      const SurfaceDisplacement d = DisplacementOf(plan, id, built->motions[s.wall.index()]);
      const Eigen::Vector2d normal = Eigen::Rotation2Dd(d.rotation_rad) * s.normal.head<2>();
      const Eigen::Vector2d on_plane = s.midpoint() + d.translation_m * s.normal.head<2>();
      const double off_m = normal.dot((T * sweep.scan.points[i].cast<double>()).head<2>() - on_plane);
      ASSERT_LT(std::abs(off_m), 5 * 0.02) << "surface " << id.value;
      ++seen[id.index()];
      sums[id.index()] += off_m;
    }
  }
  for (const WallDisplacement& w : built->walls) EXPECT_GT(seen[w.reference.index()], 500);
  for (const Room& room : plan.rooms) {
    for (const SurfaceId id : room.surfaces) {
      EXPECT_GT(seen[id.index()], 300) << id.value;
      EXPECT_NEAR(sums[id.index()] / seen[id.index()], 0, 0.003) << id.value;
    }
  }
}

}  // namespace
}  // namespace plumb::tools
