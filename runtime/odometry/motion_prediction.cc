#include "runtime/odometry/motion_prediction.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {


// Of a robot or a walking person, one sigma; less in tilt.
const Eigen::Vector3d kAcceleration_mps2(3.0, 3.0, 1.0), kTurning_radps2(1.5, 1.5, 6.0);
constexpr double kFloor_m = 0.003, kFloor_rad = 0.002;  // least sigma of any prediction: a sweep is not exactly linear in time
constexpr double kGivenScaleSigma = 0.1;                // a given odometry's relative error
constexpr double kMaxGivenSpeed_mps = 30.0;             // beyond, the given odometry has jumped
constexpr double kMaxPrediction_s = 1.0;                // velocity is not trusted for longer
constexpr double kVerticalDamping = 0.5;  // robots move along the floor: climbing at this rate dies out where no plane measures it

Matrix6d DiagonalCovariance(const Eigen::Vector3d& rotation_rad, const Eigen::Vector3d& translation_m) {
  Vector6d variances;
  variances << rotation_rad.array().square(), translation_m.array().square();
  return variances.asDiagonal();
}

// What speeding up or braking adds to a motion over dt_s that is predicted from one over earlier_s.
Matrix6d CoastingCovariance(double dt_s, double earlier_s) {
  const double product_s2 = std::abs(dt_s) * std::max(std::abs(dt_s), earlier_s);
  return DiagonalCovariance((kTurning_radps2 * product_s2).array() + kFloor_rad, (kAcceleration_mps2 * product_s2).array() + kFloor_m);
}

Matrix6d GivenCovariance(const Eigen::Isometry3d& moved) {
  return DiagonalCovariance(Eigen::Vector3d::Constant(kFloor_rad + kGivenScaleSigma * RotationAngle(moved)),
                            Eigen::Vector3d::Constant(kFloor_m + kGivenScaleSigma * moved.translation().norm()));
}

}  // namespace

Twist TwistBetween(const Eigen::Isometry3d& T_0, const Eigen::Isometry3d& T_1, double dt_s) {
  const Eigen::Isometry3d T = T_0.inverse() * T_1;
  return {T.translation() / dt_s, LogSo3(T.linear()) / dt_s};
}

Eigen::Isometry3d Advanced(const Eigen::Isometry3d& T, const Twist& twist, double dt_s, const std::optional<Eigen::Vector3d>& up) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = ExpSo3(twist.w_radps * dt_s);
  motion.translation() = twist.v_mps * dt_s;
  Eigen::Isometry3d out = T * motion;
  if (up) out.translation() -= (1 - kVerticalDamping) * up->dot(out.translation() - T.translation()) * *up;
  return out;
}

double EstimatedSweep::GapTo_s(double next_stamp_s) const {
  return std::clamp(next_stamp_s - stamp_s - sweep_s, -sweep_s, kMaxPrediction_s);
}

SweepGaussian PredictSweep(const EstimatedSweep& last, double next_stamp_s, double next_sweep_s,
                           const std::optional<Odometry::GivenMotion>& given, const std::optional<Eigen::Vector3d>& up) {
  SweepGaussian out;
  const double gap_s = last.GapTo_s(next_stamp_s);
  // The next start and motion, given the last ones' increments: start' = d + (1 + gap / sweep) e, motion' = (sweep' / sweep) e.
  Matrix12d F = Matrix12d::Zero(), Q = Matrix12d::Zero();
  F.topLeftCorner<6, 6>().setIdentity();
  if (last.sweep_s > 0) F.topRightCorner<6, 6>().setIdentity();
  // A given odometry that jumps between two sweeps was restarted: its step says nothing.
  const bool continues = given && last.given && (last.given->T_end.translation() - given->T_start.translation()).norm() <=
                                                    kMaxGivenSpeed_mps * std::max(next_stamp_s - last.stamp_s - last.sweep_s, 0.1);
  if (continues) {
    const Eigen::Isometry3d moved = last.given->T_end.inverse() * given->T_start;
    out.mean.T_start = last.motion.T_end * moved;
    Q.topLeftCorner<6, 6>() = GivenCovariance(moved);
  } else {
    out.mean.T_start = Advanced(last.motion.T_end, last.twist, gap_s, up);
    Q.topLeftCorner<6, 6>() = CoastingCovariance(gap_s, 0);
    if (last.sweep_s > 0) F.topRightCorner<6, 6>() *= 1 + gap_s / last.sweep_s;
  }
  if (given) {
    const Eigen::Isometry3d moved = given->T_start.inverse() * given->T_end;
    out.mean.T_end = out.mean.T_start * moved;
    Q.bottomRightCorner<6, 6>() = GivenCovariance(moved);
  } else {
    out.mean.T_end = Advanced(out.mean.T_start, last.twist, next_sweep_s, up);
    Q.bottomRightCorner<6, 6>() = CoastingCovariance(next_sweep_s, last.sweep_s);
    if (last.sweep_s > 0) F.bottomRightCorner<6, 6>() = next_sweep_s / last.sweep_s * Matrix6d::Identity();
  }
  if (next_sweep_s <= 0) out.mean.T_end = out.mean.T_start;
  out.covariance = F * last.covariance * F.transpose() + Q;
  return out;
}

}  // namespace plumb::runtime
