// A rigid motion of the plan that keeps z upright: x -> Rz(yaw) x + translation.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace plumb::compiler {

struct PlanarMotion {
  double cos = 1, sin = 0;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] static PlanarMotion Turn(double yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad), Eigen::Vector3d::Zero()}; }
  // Turns by `yaw_rad` and takes `from` to `to`.
  [[nodiscard]] static PlanarMotion TurnOnto(double yaw_rad, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    PlanarMotion out = Turn(yaw_rad);
    out.translation = to - out.Apply(from);
    return out;
  }

  [[nodiscard]] double yaw_rad() const { return std::atan2(sin, cos); }
  [[nodiscard]] Eigen::Vector2d Rotate(const Eigen::Vector2d& v) const { return {cos * v.x() - sin * v.y(), sin * v.x() + cos * v.y()}; }
  [[nodiscard]] Eigen::Vector2d Apply(const Eigen::Vector2d& p) const { return Rotate(p) + translation.head<2>(); }
  [[nodiscard]] Eigen::Vector3d Apply(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d xy = Apply(Eigen::Vector2d(p.head<2>()));
    return {xy.x(), xy.y(), p.z() + translation.z()};
  }
  [[nodiscard]] PlanarMotion Inverse() const {
    PlanarMotion out{cos, -sin, Eigen::Vector3d::Zero()};
    out.translation = -out.Apply(translation);
    return out;
  }
  // First `first`, then this.
  [[nodiscard]] PlanarMotion After(const PlanarMotion& first) const {
    return {cos * first.cos - sin * first.sin, sin * first.cos + cos * first.sin, Apply(first.translation)};
  }
};

}  // namespace plumb::compiler
