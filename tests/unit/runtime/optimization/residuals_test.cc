#include "runtime/optimization/residuals.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/house.h"
#include "tests/support/jacobian.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

Eigen::Vector3d RandomPoint(test::Random& random, double size) {
  return {random.Uniform(-size, size), random.Uniform(-size, size), random.Uniform(-size, size)};
}

// Points scattered about a plane patch in a keyframe's frame.
std::vector<Eigen::Vector3d> Patch(test::Random& random, int count, double noise_m) {
  const Eigen::Vector3d n = RandomPoint(random, 1).normalized(), u = n.unitOrthogonal(), v = n.cross(u), c = RandomPoint(random, 5);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(c + random.Uniform(-2, 2) * u + random.Uniform(-1, 1) * v + random.Normal(noise_m) * n);
  return points;
}

PlaneStats StatsOf(const std::vector<Eigen::Vector3d>& points) {
  PlaneStats stats;
  for (const auto& p : points) stats.Add(p);
  return stats;
}

TEST(PlaneMoments, GiveTheSumOfSquaredDistancesToAnyPlane) {
  test::Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const auto points = Patch(random, 40, 0.02);
    const PlaneMoments m = ComputeMoments(StatsOf(points));
    const Eigen::Vector3d n = RandomPoint(random, 1).normalized();
    const double d = random.Uniform(-3, 3);
    double direct = 0;
    for (const auto& p : points) direct += std::pow(n.dot(p) + d, 2);
    const double compressed = m.count * (std::pow(n.dot(m.center) + d, 2) + m.var_u * std::pow(n.dot(m.u), 2) +
                                         m.var_v * std::pow(n.dot(m.v), 2) + m.var_normal * std::pow(n.dot(m.normal), 2));
    EXPECT_NEAR(compressed, direct, 1e-9 * direct);
  }
}

TEST(PlaneMoments, SurviveSemidefiniteScatter) {
  const PlaneMoments point = ComputeMoments(StatsOf({{1, 2, 3}, {1, 2, 3}}));
  EXPECT_NEAR(point.var_u, 0, 1e-12);
  const PlaneMoments line = ComputeMoments(StatsOf({{100, 0, 0}, {101, 0, 0}, {102, 0, 0}}));
  EXPECT_GT(line.var_u, 0.5);
  EXPECT_GE(line.var_v, 0);
  const PlaneView view(StatsOf({{100, 0, 0}, {101, 0, 0}, {102, 0, 0}}), {});
  EXPECT_TRUE(std::isfinite(view.weight_v));
  EXPECT_EQ(PlaneView(PlaneStats{}, {}).weight_center, 0);
}

// A strip that clings to one end of a face turns the plane that is fitted to it: in every view alike.
TEST(PlaneView, AllowsForWhatClingsToTheEdge) {
  constexpr double kHeight_m = 0.02, kWidth_m = 0.1;
  for (const double length_m : {0.6, 1.0, 3.0}) {
    std::vector<Eigen::Vector3d> points;
    for (double x = 0.0005; x < length_m; x += 0.001) {
      for (const double z : {-1.0, 1.0}) points.emplace_back(x, x < kWidth_m ? kHeight_m : 0, z);
    }
    const PlaneMoments m = ComputeMoments(StatsOf(points));
    const double turned_rad = std::abs(std::atan2(m.normal.x(), m.normal.y()));
    const double along = std::abs(m.u.x()) > 0.5 ? m.var_u : m.var_v;
    ViewNoise noise{1e-6, 1, 0.0, 0.0, kHeight_m * kWidth_m};
    for (const size_t views : {1, 9}) {
      const PlaneView view(StatsOf(points), noise, views);
      const double weight = std::abs(view.u.x()) > 0.5 ? view.weight_u : view.weight_v;
      // All views together, each with the same error.
      const double sigma_rad = 1 / (weight * std::sqrt(static_cast<double>(views)));
      EXPECT_NEAR(sigma_rad, noise.edge_m2 / (2 * along), 0.05 * sigma_rad) << length_m << " m, " << views;
      EXPECT_NEAR(sigma_rad, turned_rad, 0.25 * turned_rad) << length_m << " m, " << views;
    }
  }
}

TEST(PlaneView, IsZeroOnThePointsPlaneAndWeighsInSigmas) {
  test::Random random(2);
  const auto points = Patch(random, 1000, 0.0);
  const PlaneMoments m = ComputeMoments(StatsOf(points));
  const PlaneView view(StatsOf(points), {0.03, 10, 0.0, 0.0, 0.0});
  double r[3];
  view.Residual(m.normal, -m.normal.dot(m.center), r);
  for (double x : r) EXPECT_NEAR(x, 0, 1e-6);
  // 1 cm off: 0.01 / (0.03 sqrt(10 / 1000)).
  view.Residual(m.normal, 0.01 - m.normal.dot(m.center), r);
  EXPECT_NEAR(r[0], 0.01 / 0.003, 1e-6);
  // However many points, never better than the floor.
  const PlaneView floored(StatsOf(points), {0.03, 10, 0.005, 0.003});
  EXPECT_NEAR(1 / floored.weight_center, std::hypot(0.003, 0.005), 1e-9);
  EXPECT_LT(floored.weight_u, 1 / 0.003);
}

TEST(PlaneView, SmearBlursWhatItMovesAndTurnsOnly) {
  test::Random random(4);
  const auto points = Patch(random, 1000, 0.0);
  const PlaneMoments m = ComputeMoments(StatsOf(points));
  const auto view_with = [&](const Smear& smear) { return PlaneView(StatsOf(points), {0.03, 10, 0.005, 0.003, 0.0, smear}); };
  const PlaneView sharp = view_with({});
  const PlaneView along = view_with({.m2 = 0.05 * 0.05 * m.u * m.u.transpose()}),
                  across = view_with({.m2 = 0.05 * 0.05 * m.normal * m.normal.transpose()});
  EXPECT_NEAR(along.weight_center, sharp.weight_center, 1e-3 * sharp.weight_center) << "driving along a wall";
  EXPECT_NEAR(1 / across.weight_center, std::hypot(1 / sharp.weight_center, 0.05), 1e-6) << "driving towards it";
  EXPECT_NEAR(across.weight_u, sharp.weight_u, 1e-9);
  // A turn about v moves the centre across by its distance along u, and turns the normal towards u.
  const PlaneView turned = view_with({.rad2 = 0.02 * 0.02 * m.v * m.v.transpose()});
  EXPECT_NEAR(1 / turned.weight_center, std::hypot(1 / sharp.weight_center, 0.02 * m.center.dot(m.u)), 1e-6);
  EXPECT_NEAR(1 / turned.weight_u, std::hypot(1 / sharp.weight_u, 0.02), 1e-6);
  EXPECT_NEAR(turned.weight_v, sharp.weight_v, 1e-6 * sharp.weight_v);
}

Vector<7> RandomPose(test::Random& random) {
  Vector<7> pose;
  const Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::AngleAxisd(random.Uniform(-2, 2), RandomPoint(random, 1).normalized()));
  pose << q.coeffs(), RandomPoint(random, 3);
  return pose;
}

struct RandomScene {
  explicit RandomScene(uint64_t seed) : random(seed), view(StatsOf(Patch(random, 60, 0.02)), {}) {
    const AGraph house = test::MakeHouse();
    const std::vector<WallFrame> frames = WallFrames(house);
    const Surface& surface = house.surfaces[static_cast<size_t>(random.Uniform(0, static_cast<double>(house.surfaces.size()) - 0.01))];
    face = MakeFace(frames[surface.wall.index()], surface);
  }
  test::Random random;
  PlaneView view;
  Face face;
};

// A view of a plane tells three numbers of whatever it is a view of: an offset and two turns. Of a level's height and of the place, a
// floor tells one number and the place's tilts are none of its parameters. A motion tells all six, of each of its ends.
TEST(Residuals, HaveTheJacobiansOfDifferencesAndTheirRanks) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    RandomScene s(seed);
    const WallViewResidual wall{s.view, s.face};
    Vector<16> x;
    x << RandomPose(s.random), RandomPoint(s.random, 5), s.random.Uniform(-3, 3), 0.2, 0.1, 0.02, 0.01, 0.015;
    const auto by_wall = test::CheckedJacobian<3, 16>([&](const auto* p, auto* r) { wall(p, p + 7, p + 11, p + 15, r); }, x);
    EXPECT_EQ(test::Rank(by_wall.leftCols<7>() * test::PoseTangent(x.head<7>())), 3);
    EXPECT_EQ(test::Rank(by_wall.middleCols<4>(7)), 2) << "position across it, yaw";
    EXPECT_EQ(test::Rank(by_wall.middleCols<3>(11)), 3) << "offset, yaw, tilt";
    EXPECT_EQ(test::Rank(by_wall.rightCols<2>()), 1) << "thickness and bias are one number to a single face";

    const LevelViewResidual level{s.view, 2.5, seed % 2 ? 1.0 : -1.0};
    Vector<12> y;
    y << RandomPose(s.random), RandomPoint(s.random, 5), 1.0, 0.01;
    const auto by_level = test::CheckedJacobian<3, 12>([&](const auto* p, auto* r) { level(p, p + 7, p + 11, r); }, y);
    EXPECT_EQ(test::Rank(by_level.leftCols<7>() * test::PoseTangent(y.head<7>())), 3);
    EXPECT_EQ(test::Rank(by_level.rightCols<5>()), 1) << "the place's height and the level's are one number to it";

    const FreeViewResidual free{s.view};
    Vector<11> z;
    z << RandomPose(s.random), RandomPoint(s.random, 1).normalized(), 2.0;
    const auto by_plane = test::CheckedJacobian<3, 11>([&](const auto* p, auto* r) { free(p, p + 7, r); }, z);
    EXPECT_EQ(test::Rank(by_plane.leftCols<7>() * test::PoseTangent(z.head<7>())), 3);
    EXPECT_EQ(test::Rank(by_plane.rightCols<4>()), 3);

    const OdometryResidual odometry{
        Eigen::Translation3d(RandomPoint(s.random, 1)) * Eigen::AngleAxisd(0.3, RandomPoint(s.random, 1).normalized()), 0.01, 0.002};
    Vector<14> w;
    w << RandomPose(s.random), RandomPose(s.random);
    const auto by_motion = test::CheckedJacobian<6, 14>([&](const auto* p, auto* r) { odometry(p, p + 7, r); }, w);
    EXPECT_EQ(test::Rank(by_motion.leftCols<7>() * test::PoseTangent(w.head<7>())), 6);
    EXPECT_EQ(test::Rank(by_motion.rightCols<7>() * test::PoseTangent(w.tail<7>())), 6);

    const AnchorResidual anchor{Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX())), 0.1,
                                0.1, 0.2};
    const Vector<7> pose = RandomPose(s.random);
    const auto by_pose = test::CheckedJacobian<6, 7>([&](const auto* p, auto* r) { anchor(p, r); }, pose);
    EXPECT_EQ(test::Rank(by_pose * test::PoseTangent(pose)), 6);

    const std::array<double, 4> weight{100, 0, 2, 30};
    const PriorResidual<4> prior{{0.1, 0.2, 0.3, 0.4}, &weight};
    const auto by_block = test::CheckedJacobian<4, 4>([&](const auto* p, auto* r) { prior(p, r); }, Vector<4>::Random());
    EXPECT_EQ(test::Rank(by_block), 3) << "a weight of zero is no prior";
  }
}

// What moves towards the side that a plane faces lowers the points' distances to it.
TEST(Residuals, HaveTheSignOfMeasuredMinusModelled) {
  RandomScene s(1);
  const Vector<7> at_origin = (Vector<7>() << 0, 0, 0, 1, 0, 0, 0).finished();
  const double no_place[4] = {}, no_bias = 0, bias = 0.01, no_deviation[4] = {}, moved[4] = {s.face.side() * 0.01, 0, 0, 0},
               thicker[4] = {0, 0, 0, 0.02};
  const double weight = s.view.weight_center;
  Eigen::Vector3d planned, r;
  const WallViewResidual wall{s.view, s.face};
  wall(at_origin.data(), no_place, no_deviation, &no_bias, planned.data());
  wall(at_origin.data(), no_place, moved, &no_bias, r.data());
  EXPECT_NEAR(r[0] - planned[0], -0.01 * weight, 1e-6 * weight) << "the wall nearer to the robot";
  wall(at_origin.data(), no_place, thicker, &no_bias, r.data());
  EXPECT_NEAR(r[0] - planned[0], -0.01 * weight, 1e-6 * weight) << "either face by half of what it is thicker";
  wall(at_origin.data(), no_place, no_deviation, &bias, r.data());
  EXPECT_NEAR(r[0] - planned[0], -0.01 * weight, 1e-6 * weight) << "ranges too short look like a nearer wall";
  const double place[4] = {0.01 * s.face.normal.x(), 0.01 * s.face.normal.y(), 0, 0};
  wall(at_origin.data(), place, no_deviation, &no_bias, r.data());
  EXPECT_NEAR(r[0] - planned[0], 0.01 * weight, 1e-6 * weight) << "the robot farther from the wall";

  const double level = 0, raised = 0.01, lifted[4] = {0, 0, 0.01, 0};
  for (const double up : {1.0, -1.0}) {
    const LevelViewResidual view{s.view, 2.5, up};
    view(at_origin.data(), no_place, &level, planned.data());
    view(at_origin.data(), no_place, &raised, r.data());
    EXPECT_NEAR(r[0] - planned[0], -up * 0.01 * weight, 1e-6 * weight) << "nearer as a floor, farther as a ceiling";
    view(at_origin.data(), lifted, &raised, r.data());
    EXPECT_NEAR((r - planned).norm(), 0, 1e-9 * weight) << "the robot lifted with it";
  }

  const Vector<7> ahead = (Vector<7>() << 0, 0, std::sin(0.01), std::cos(0.01), 1.02, 0, 0).finished();
  Vector<6> e;
  const OdometryResidual odometry{Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0)), 0.01, 0.002};
  odometry(at_origin.data(), ahead.data(), e.data());
  EXPECT_LT((e - (Vector<6>() << 2, 0, 0, 0, 0, 10).finished()).norm(), 1e-3) << "farther and more to the left than measured";
  const AnchorResidual anchor{Eigen::Isometry3d::Identity(), 0.01, 0.002, 0.2};
  anchor(ahead.data(), e.data());
  EXPECT_LT((e - (Vector<6>() << 102, 0, 0, 0, 0, 10).finished()).norm(), 1e-3);
  const std::array<double, 1> prior_weight{100};
  double p = 0;
  PriorResidual<1>{{0.5}, &prior_weight}(&raised, &p);
  EXPECT_NEAR(p, -49, 1e-12);
}

TEST(LevelStepResidual, ComparesMotionsOfTheLevelledFrames) {
  const Eigen::Matrix3d level_a = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix(), level_b = level_a.transpose();
  const LeveledPose a{{{1, 2}, 3.0}, level_a, 0.5}, b{{{1.4, 2.3}, -3.1}, level_b, 0.5};
  LevelStepResidual step{Between(a.pose, b.pose), Eigen::Vector3d(1 / 0.01, 1 / 0.02, 1 / 0.005).asDiagonal(),
                         Eigen::Quaterniond(level_a).conjugate(), Eigen::Quaterniond(level_b).conjugate()};
  const auto block = [](const LeveledPose& pose) {
    Vector<7> x;
    x << Eigen::Quaterniond(pose.Lifted().linear()).coeffs(), pose.Lifted().translation();
    return x;
  };
  Vector<14> x;
  x << block(a), block(b);
  Eigen::Vector3d r;
  step(x.data(), x.data() + 7, r.data());
  EXPECT_LT(r.norm(), 1e-9);
  step.T_a_b.yaw_rad -= 0.01;  // the robot turned further than measured, by two sigmas
  step.T_a_b.t_m.x() -= 0.01;
  step(x.data(), x.data() + 7, r.data());
  EXPECT_NEAR(r.x(), 1, 1e-6);
  EXPECT_NEAR(r.y(), 0, 1e-6);
  EXPECT_NEAR(r.z(), 2, 1e-3);
  x.tail<7>().head<4>() *= -1;  // the same orientation
  step(x.data(), x.data() + 7, r.data());
  EXPECT_NEAR(r.z(), 2, 1e-3);
  const auto J = test::CheckedJacobian<3, 14>([&](const auto* p, auto* out) { step(p, p + 7, out); }, x);
  EXPECT_EQ(test::Rank(J.leftCols<7>() * test::PoseTangent(x.head<7>())), 3);
  EXPECT_EQ(test::Rank(J.rightCols<7>() * test::PoseTangent(x.tail<7>())), 3);
}

TEST(Residuals, AreZeroAtTheTruth) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    RandomScene s(seed);
    const double wall[4] = {0.2, 0.1, 0.02, 0.01}, bias = 0.015;
    const Eigen::Vector3d t = RandomPoint(s.random, 5);
    const double place[4] = {t.x(), t.y(), t.z(), 0.7};
    Eigen::Isometry3d T_plan_map = Eigen::Isometry3d::Identity();
    T_plan_map.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T_plan_map.translation() = t;
    const Vector<7> pose = RandomPose(s.random);
    Eigen::Isometry3d T_map_kf = Eigen::Isometry3d::Identity();
    T_map_kf.linear() = Eigen::Quaterniond(pose.data()).toRotationMatrix();
    T_map_kf.translation() = pose.tail<3>();
    // Points of the built wall, seen through the bias, in the keyframe's frame.
    Plane built;
    BuiltPlane(s.face, wall, &built.n, &built.d);
    PlaneStats stats;
    for (int i = 0; i < 30; ++i) {
      Eigen::Vector3d p = RandomPoint(s.random, 3);
      p -= (built.SignedDistance(p) - bias) * built.n;
      stats.Add((T_plan_map * T_map_kf).inverse() * p);
    }
    double r[3];
    WallViewResidual{PlaneView(stats, {}), s.face}(pose.data(), place, wall, &bias, r);
    for (double x : r) EXPECT_NEAR(x, 0, 1e-5);
  }
}

// A plane fixes three of a rigid motion's six degrees of freedom. Of the wall's own (offset, yaw, tilt) none is left open.
TEST(Deviation, TwoParametersAndTiltHaveNoFreeDirectionWhileSixHave) {
  RandomScene s(3);
  const auto plane_of = [&](const Eigen::Matrix<double, 6, 1>& x) {  // x: translation, rotation about the pivot
    const Eigen::AngleAxisd turn(x.tail<3>().norm(),
                                 x.tail<3>().norm() > 0 ? Eigen::Vector3d(x.tail<3>().normalized()) : Eigen::Vector3d::UnitX());
    const Eigen::Vector3d n = turn * s.face.normal;
    return Eigen::Vector4d(n.x(), n.y(), n.z(), -n.dot(s.face.pivot + turn * (s.face.point - s.face.pivot) + x.head<3>()));
  };
  Eigen::Matrix<double, 4, 6> six;
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> lo = Eigen::Matrix<double, 6, 1>::Zero(), hi = lo;
    lo[i] = -1e-5;
    hi[i] = 1e-5;
    six.col(i) = (plane_of(hi) - plane_of(lo)) / 2e-5;
  }
  Eigen::Matrix<double, 4, 3> own;
  for (int i = 0; i < 3; ++i) {
    double lo[4] = {}, hi[4] = {};
    lo[i] = -1e-5;
    hi[i] = 1e-5;
    Plane a, b;
    BuiltPlane(s.face, lo, &a.n, &a.d);
    BuiltPlane(s.face, hi, &b.n, &b.d);
    own.col(i) << (b.n - a.n) / 2e-5, (b.d - a.d) / 2e-5;
  }
  EXPECT_EQ(test::Rank(six), 3);
  EXPECT_EQ(test::Rank(own), 3);
}

// Why deviations need a prior: one that appears in its own factor only takes up all that the factor says, whatever the factor's weight.
TEST(Deviation, WithoutPriorItAbsorbsItsOwnFactor) {
  const auto information_on_place = [](double weight, double prior) {  // x = (place, deviation); factor weight * (place - deviation)^2
    Eigen::Matrix2d h;
    h << weight, -weight, -weight, weight + prior;
    return h(0, 0) - h(0, 1) * h(1, 0) / h(1, 1);
  };
  for (double weight : {1.0, 1e2, 1e6}) EXPECT_NEAR(information_on_place(weight, 0), 0, 1e-9 * weight);
  EXPECT_NEAR(information_on_place(1e6, 100), 1e6 * 100 / (1e6 + 100), 1e-6);
}

}  // namespace
}  // namespace plumb::runtime
