#include "tools/simulate/drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace plumb::tools {
namespace {

constexpr double kSpacing_m = 0.02;         // between points of a rounded line
constexpr double kLargestTrim_m = 0.6;      // a corner is rounded from this far before it
constexpr double kSmallestTrim_m = 0.08;
constexpr double kSharpTurn_rad = 1.9;      // from here on the robot turns in place
constexpr double kSmoothing_s = 0.25;       // window of each of two moving averages

double Angle(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }
double Wrapped(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi); }

void AppendStraight(Polyline& line, const Eigen::Vector2d& to) {
  const Eigen::Vector2d from = line.back();
  const int steps = std::max(2, static_cast<int>(std::ceil((to - from).norm() / kSpacing_m)));  // one to speed up, one to brake
  for (int i = 1; i <= steps; ++i) line.emplace_back(from + (to - from) * (static_cast<double>(i) / steps));
}

// Rounds the corner at b with a parabola that leaves the lines `trim_m` from it; false if it has less clearance than the radius.
bool AppendCorner(Polyline& line, const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, double trim_m,
                  const FreeSpace& space, double radius_m) {
  const Eigen::Vector2d p = b + (a - b).normalized() * trim_m, q = b + (c - b).normalized() * trim_m;
  const int steps = std::max(4, static_cast<int>(std::ceil(2 * trim_m / kSpacing_m)));
  Polyline curve;
  for (int i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    curve.emplace_back((1 - t) * (1 - t) * p + 2 * t * (1 - t) * b + t * t * q);
    if (space.ClearanceAt(curve.back()) < radius_m) return false;
  }
  AppendStraight(line, p);
  line.insert(line.end(), curve.begin(), curve.end());
  return true;
}

// Pieces of the route without corners that are too sharp to drive through; the robot stops between them.
std::vector<Polyline> RoundCorners(const Polyline& route, const FreeSpace& space, double radius_m) {
  std::vector<Polyline> lines;
  Polyline line = {route.front()};
  const auto close = [&](const Eigen::Vector2d& at) {
    if ((at - line.back()).norm() > 1e-9) AppendStraight(line, at);
    if (line.size() > 1) lines.push_back(line);
    line = {at};
  };
  for (size_t i = 1; i + 1 < route.size(); ++i) {
    const Eigen::Vector2d &a = route[i - 1], &b = route[i], &c = route[i + 1];
    const double turn_rad = std::abs(Wrapped(Angle(c - b) - Angle(b - a)));
    bool rounded = false;
    if (turn_rad < kSharpTurn_rad) {
      double trim_m = std::min({kLargestTrim_m, 0.45 * (b - a).norm(), 0.45 * (c - b).norm()});
      for (; !rounded && trim_m >= kSmallestTrim_m; trim_m /= 1.5) rounded = AppendCorner(line, a, b, c, trim_m, space, radius_m);
    }
    if (!rounded) close(b);
  }
  close(route.back());
  return lines;
}

struct Knot {
  double time_s, x_m, y_m, yaw_rad;
};

// Strings manoeuvres together: knots in time with rest at every stop.
class Driver {
 public:
  Driver(const Eigen::Vector2d& start, double yaw_rad, const DriveOptions& options) : options_(options) {
    knots_.push_back({0, start.x(), start.y(), yaw_rad});
    Rest();
  }

  void Rest() {
    knots_.push_back(knots_.back());
    knots_.back().time_s += options_.rest_s;
  }

  void Turn(double angle_rad) {
    if (std::abs(angle_rad) < 1e-6) return;
    // Accelerate, turn, brake: times from the area under the trapezoid.
    const double angle = std::abs(angle_rad), rate = std::min(options_.yaw_rate_rad_s, std::sqrt(angle * options_.yaw_acceleration_rad_s2));
    const double ramp_s = rate / options_.yaw_acceleration_rad_s2, total_s = angle / rate + ramp_s;
    const Knot from = knots_.back();
    const int steps = std::max(2, static_cast<int>(std::ceil(total_s / 0.02)));
    for (int i = 1; i <= steps; ++i) {
      const double t = total_s * i / steps;
      double turned = rate * (t - 0.5 * ramp_s);
      if (t < ramp_s) turned = 0.5 * options_.yaw_acceleration_rad_s2 * t * t;
      if (t > total_s - ramp_s) turned = angle - 0.5 * options_.yaw_acceleration_rad_s2 * (total_s - t) * (total_s - t);
      knots_.push_back({from.time_s + t, from.x_m, from.y_m, from.yaw_rad + std::copysign(turned, angle_rad)});
    }
  }

  void Follow(const Polyline& points) {
    Turn(Wrapped(Angle(points[1] - points[0]) - knots_.back().yaw_rad));
    const std::vector<double> speeds = Speeds(points);
    for (size_t i = 1; i < points.size(); ++i) {
      const Knot& last = knots_.back();
      const double length_m = (points[i] - points[i - 1]).norm(), speed = 0.5 * (speeds[i - 1] + speeds[i]);
      const Eigen::Vector2d ahead = points[std::min(i + 1, points.size() - 1)] - points[i - 1];
      knots_.push_back({last.time_s + length_m / speed, points[i].x(), points[i].y(), last.yaw_rad + Wrapped(Angle(ahead) - last.yaw_rad)});
    }
  }

  [[nodiscard]] const std::vector<Knot>& knots() const { return knots_; }

 private:
  // As fast as speed, curvature and acceleration allow, from rest to rest.
  [[nodiscard]] std::vector<double> Speeds(const Polyline& points) const {
    std::vector<double> speeds(points.size(), options_.speed_m_s);
    for (size_t i = 1; i + 1 < points.size(); ++i) {
      const Eigen::Vector2d in = points[i] - points[i - 1], out = points[i + 1] - points[i];
      const double curvature = std::abs(Wrapped(Angle(out) - Angle(in))) / (0.5 * (in.norm() + out.norm()));
      if (curvature > 1e-6) speeds[i] = std::min(speeds[i], options_.yaw_rate_rad_s / curvature);
    }
    speeds.front() = speeds.back() = 0;
    const auto limit = [&](size_t from, size_t to) {
      const double length_m = (points[to] - points[from]).norm();
      speeds[to] = std::min(speeds[to], std::sqrt(speeds[from] * speeds[from] + 2 * options_.acceleration_m_s2 * length_m));
    };
    for (size_t i = 1; i < points.size(); ++i) limit(i - 1, i);
    for (size_t i = points.size() - 1; i > 0; --i) limit(i, i - 1);
    return speeds;
  }

  const DriveOptions& options_;
  std::vector<Knot> knots_;
};

// One value each kStep_s.
template <class Value>
std::vector<double> Resample(const std::vector<Knot>& knots, Value value) {
  std::vector<double> out;
  const auto count = static_cast<size_t>(std::floor(knots.back().time_s / Drive::kStep_s)) + 1;
  for (size_t i = 0, k = 0; i < count; ++i) {
    const double t = static_cast<double>(i) * Drive::kStep_s;
    while (k + 2 < knots.size() && knots[k + 1].time_s <= t) ++k;
    const double span_s = knots[k + 1].time_s - knots[k].time_s;
    const double ratio = span_s > 0 ? std::clamp((t - knots[k].time_s) / span_s, 0.0, 1.0) : 1;
    out.push_back(value(knots[k]) + ratio * (value(knots[k + 1]) - value(knots[k])));
  }
  return out;
}

std::vector<double> MovingAverage(const std::vector<double>& in) {
  const auto half = static_cast<ptrdiff_t>(kSmoothing_s / Drive::kStep_s / 2), n = static_cast<ptrdiff_t>(in.size());
  const auto at = [&](ptrdiff_t i) { return in[static_cast<size_t>(std::clamp<ptrdiff_t>(i, 0, n - 1))]; };
  std::vector<double> out(in.size());
  for (ptrdiff_t i = 0; i < n; ++i) {
    double sum = 0;
    for (ptrdiff_t k = -half; k <= half; ++k) sum += at(i + k);
    out[static_cast<size_t>(i)] = sum / static_cast<double>(2 * half + 1);
  }
  return out;
}

// Three slow sines, together at most `amplitude_rad`.
class Wobble {
 public:
  Wobble(double amplitude_rad, Random& random) : amplitude_rad_(amplitude_rad / 3) {
    for (size_t i = 0; i < 3; ++i) {
      frequency_rad_s_[i] = 2 * std::numbers::pi * random.Uniform(0.3, 1.5);
      phase_rad_[i] = random.Uniform(0, 2 * std::numbers::pi);
    }
  }
  [[nodiscard]] double At(double t) const {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) sum += std::sin(frequency_rad_s_[i] * t + phase_rad_[i]);
    return amplitude_rad_ * sum;
  }

 private:
  double amplitude_rad_;
  std::array<double, 3> frequency_rad_s_{}, phase_rad_{};
};

}  // namespace

Drive::Drive(const std::vector<Manoeuvre>& manoeuvres, double start_yaw_rad, const FreeSpace& space, double radius_m,
             const DriveOptions& options, Random& random) {
  Driver driver(manoeuvres.front().line.front(), start_yaw_rad, options);
  for (const Manoeuvre& m : manoeuvres) {
    if (m.line.size() > 1) {
      for (const Polyline& line : RoundCorners(m.line, space, radius_m)) driver.Follow(line);
    }
    driver.Turn(m.turn_rad);
  }
  driver.Rest();
  const auto smooth = [&](auto value) { return MovingAverage(MovingAverage(Resample(driver.knots(), value))); };
  const std::vector<double> x_m = smooth([](const Knot& k) { return k.x_m; }), y_m = smooth([](const Knot& k) { return k.y_m; });
  const std::vector<double> yaw_rad = smooth([](const Knot& k) { return k.yaw_rad; });
  const Wobble roll(options.wobble_rad, random), pitch(options.wobble_rad, random);
  for (size_t i = 0; i < x_m.size(); ++i) {
    const double t = static_cast<double>(i) * kStep_s;
    positions_.emplace_back(x_m[i], y_m[i], space.floor_z_m() + options.sensor_height_m);
    Eigen::Quaterniond q = Eigen::AngleAxisd(yaw_rad[i], Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(pitch.At(t), Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(roll.At(t), Eigen::Vector3d::UnitX());
    if (i > 0 && q.dot(orientations_.back()) < 0) q.coeffs() = -q.coeffs();
    orientations_.push_back(q);
  }
}

Eigen::Isometry3d Drive::PoseAt(double time_s) const {
  const double step = std::clamp(time_s / kStep_s, 0.0, static_cast<double>(positions_.size() - 1));
  const size_t i = std::min(static_cast<size_t>(step), positions_.size() - 1), k = std::min(i + 1, positions_.size() - 1);
  const double ratio = step - static_cast<double>(i);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = (1 - ratio) * positions_[i] + ratio * positions_[k];
  // A hundredth of a second apart the chord is as good as the arc.
  Eigen::Quaterniond q;
  q.coeffs() = (1 - ratio) * orientations_[i].coeffs() + ratio * orientations_[k].coeffs();
  T.linear() = q.normalized().toRotationMatrix();
  return T;
}

void Drive::CutAt(double time_s) {
  const auto count = static_cast<size_t>(std::floor(time_s / kStep_s)) + 1;
  if (count >= positions_.size()) return;
  positions_.resize(count);
  orientations_.resize(count);
}

}  // namespace plumb::tools
