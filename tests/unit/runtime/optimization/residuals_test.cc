#include "runtime/optimization/residuals.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <unsupported/Eigen/AutoDiff>

#include "tests/support/house.h"
#include "tests/support/synthetic_sgraph.h"

namespace plumb::runtime {
namespace {

using Jet = Eigen::AutoDiffScalar<Eigen::VectorXd>;

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

// Jacobian by automatic differentiation against central differences, for any residual over a list of parameter blocks.
template <int kResiduals, class Call>
void ExpectJacobian(const Call& call, const Eigen::VectorXd& x) {
  const auto value = [&](const Eigen::VectorXd& at) {
    Eigen::Matrix<double, kResiduals, 1> r;
    call(at.data(), r.data());
    return r;
  };
  std::vector<Jet> jets;
  for (Eigen::Index i = 0; i < x.size(); ++i) jets.emplace_back(x[i], x.size(), i);
  std::vector<Jet> r(kResiduals);
  call(jets.data(), r.data());
  constexpr double h = 1e-6;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd lo = x, hi = x;
    lo[i] -= h;
    hi[i] += h;
    const Eigen::Matrix<double, kResiduals, 1> numeric = (value(hi) - value(lo)) / (2 * h);
    for (int k = 0; k < kResiduals; ++k) {
      const double automatic = r[static_cast<size_t>(k)].derivatives().size() ? r[static_cast<size_t>(k)].derivatives()[i] : 0.0;
      EXPECT_NEAR(automatic, numeric[k], 1e-4 * std::max(1.0, std::abs(numeric[k]))) << "residual " << k << " parameter " << i;
    }
  }
}

Eigen::VectorXd RandomPose(test::Random& random) {
  Eigen::VectorXd pose(7);
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

TEST(Residuals, JacobiansAgreeWithDifferences) {
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    RandomScene s(seed);
    const WallViewResidual wall{s.view, s.face};
    Eigen::VectorXd x(16);
    x << RandomPose(s.random), RandomPoint(s.random, 5), s.random.Uniform(-3, 3), 0.2, 0.1, 0.02, 0.01, 0.015;
    ExpectJacobian<3>([&](const auto* p, auto* r) { wall(p, p + 7, p + 11, p + 15, r); }, x);

    const LevelViewResidual level{s.view, 2.5, seed % 2 ? 1.0 : -1.0};
    Eigen::VectorXd y(12);
    y << RandomPose(s.random), RandomPoint(s.random, 5), 1.0, 0.01;
    ExpectJacobian<3>([&](const auto* p, auto* r) { level(p, p + 7, p + 11, r); }, y);

    const FreeViewResidual free{s.view};
    Eigen::VectorXd z(11);
    z << RandomPose(s.random), RandomPoint(s.random, 1).normalized(), 2.0;
    ExpectJacobian<3>([&](const auto* p, auto* r) { free(p, p + 7, r); }, z);

    const OdometryResidual odometry{
        Eigen::Translation3d(RandomPoint(s.random, 1)) * Eigen::AngleAxisd(0.3, RandomPoint(s.random, 1).normalized()), 0.01, 0.002};
    Eigen::VectorXd w(14);
    w << RandomPose(s.random), RandomPose(s.random);
    ExpectJacobian<6>([&](const auto* p, auto* r) { odometry(p, p + 7, r); }, w);

    const AnchorResidual anchor{Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX())), 0.1,
                                0.1, 0.2};
    ExpectJacobian<6>([&](const auto* p, auto* r) { anchor(p, r); }, RandomPose(s.random));
  }
}

TEST(LevelStepResidual, ComparesMotionsOfTheLevelledFrames) {
  const Eigen::Matrix3d level_a = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix(), level_b = level_a.transpose();
  const LeveledPose a{{{1, 2}, 3.0}, level_a, 0.5}, b{{{1.4, 2.3}, -3.1}, level_b, 0.5};
  LevelStepResidual step{Between(a.pose, b.pose), Eigen::Vector3d(1 / 0.01, 1 / 0.02, 1 / 0.005).asDiagonal(),
                         Eigen::Quaterniond(level_a).conjugate(), Eigen::Quaterniond(level_b).conjugate()};
  const auto block = [](const LeveledPose& pose) {
    Eigen::VectorXd x(7);
    x << Eigen::Quaterniond(pose.Lifted().linear()).coeffs(), pose.Lifted().translation();
    return x;
  };
  Eigen::VectorXd x(14);
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
  ExpectJacobian<3>([&](const auto* p, auto* out) { step(p, p + 7, out); }, x);
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
    const Eigen::VectorXd pose = RandomPose(s.random);
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
  const auto rank = [](const Eigen::MatrixXd& m) {
    Eigen::FullPivLU<Eigen::MatrixXd> lu(m);
    lu.setThreshold(1e-6);
    return lu.rank();
  };
  EXPECT_EQ(rank(six), 3);
  EXPECT_EQ(rank(own), 3);
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
