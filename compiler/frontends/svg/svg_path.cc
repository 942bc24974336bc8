#include "compiler/frontends/svg/svg_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "compiler/frontends/svg/svg_values.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kCloses = 1e-4;  // of an outline, between its ends
constexpr double kPi = std::numbers::pi;
constexpr double kStep_rad = kPi / 48;  // keeps within 0.05 % of the radius
constexpr int kMaxSteps = 96;  // of one curve

double TurnBetween(const Vector2d& a, const Vector2d& b) {
  if (a.norm() <= 0 || b.norm() <= 0) return 0;
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

// About x and y of an ellipse turned by `angle`, from the center.
Vector2d OnEllipse(const Vector2d& center, const Vector2d& radius, double angle, double at) {
  const Vector2d p(radius.x() * std::cos(at), radius.y() * std::sin(at));
  return center + Vector2d(std::cos(angle) * p.x() - std::sin(angle) * p.y(), std::sin(angle) * p.x() + std::cos(angle) * p.y());
}

class PathReader {
 public:
  PathReader(std::string_view data, size_t max_points) : scanner_(data), max_points_(max_points) {}

  SvgPathData Run() {
    char command = 0;
    for (scanner_.SkipSpace(); !scanner_.at_end() && points_ < max_points_; scanner_.SkipSpace()) {
      if (std::string_view("MmLlHhVvCcSsQqTtAaZz").find(scanner_.front()) != std::string_view::npos) {
        command = scanner_.front();
        scanner_.Skip(1);
      } else if (command == 'M' || command == 'm') {
        command = command == 'M' ? 'L' : 'l';  // further pairs are lines
      } else if (command == 'Z' || command == 'z') {
        command = 0;
      }
      const bool starts = command == 'M' || command == 'm';
      if (command == 0 || (!started_ && !starts) || !Do(command)) {
        out_.faulty = true;
        break;
      }
      started_ = true;
    }
    out_.faulty |= points_ >= max_points_;
    Finish(false);
    return std::move(out_);
  }

 private:
  bool Do(char command) {
    const bool relative = command >= 'a';
    const Vector2d origin = relative ? at_ : Vector2d::Zero();
    const char kind = relative ? static_cast<char>(command - 'a' + 'A') : command;
    switch (kind) {
      case 'Z': return Close();
      case 'A': return EllipticArc(origin);
      case 'H':
      case 'V': return Straight(kind, origin);
      default: return Curve(kind, origin);
    }
  }

  bool Close() {
    Finish(true);
    at_ = last_control_ = start_;
    last_ = 'Z';
    return true;
  }

  bool Straight(char kind, const Vector2d& origin) {
    const auto v = scanner_.Number();
    if (!v) return false;
    LineTo(kind == 'H' ? Vector2d(origin.x() + *v, at_.y()) : Vector2d(at_.x(), origin.y() + *v));
    last_ = kind;
    return true;
  }

  // M, L and the splines, by the number of their points.
  bool Curve(char kind, const Vector2d& origin) {
    const size_t count = kind == 'C' ? 3 : kind == 'S' || kind == 'Q' ? 2 : 1;
    Vector2d p[3];
    for (size_t i = 0; i < count; ++i) {
      const auto x = scanner_.Number(), y = x ? scanner_.Number() : std::nullopt;
      if (!y) return false;
      p[i] = origin + Vector2d(*x, *y);
    }
    const Vector2d mirrored = 2 * at_ - last_control_;
    const bool after_cubic = last_ == 'C' || last_ == 'S', after_quadratic = last_ == 'Q' || last_ == 'T';
    switch (kind) {
      case 'M':
        Finish(false);
        at_ = start_ = p[0];
        break;
      case 'L': LineTo(p[0]); break;
      case 'C': Cubic(p[0], p[1], p[2]); break;
      case 'S': Cubic(after_cubic ? mirrored : at_, p[0], p[1]); break;
      case 'Q': Quadratic(p[0], p[1]); break;
      default: Quadratic(after_quadratic ? mirrored : at_, p[0]); break;
    }
    if (kind == 'M' || kind == 'L') last_control_ = at_;
    last_ = kind;
    return true;
  }

  void LineTo(const Vector2d& to) {
    if (outline_.points.empty()) Add(at_);
    Add(to);
    at_ = last_control_ = to;
  }

  void Quadratic(const Vector2d& control, const Vector2d& to) {
    Cubic(at_ + 2.0 / 3 * (control - at_), to + 2.0 / 3 * (control - to), to);
    last_control_ = control;
  }

  void Cubic(const Vector2d& c1, const Vector2d& c2, const Vector2d& to) {
    const Vector2d from = at_;
    if (outline_.points.empty()) Add(from);
    const double turn = TurnBetween(c1 - from, c2 - c1) + TurnBetween(c2 - c1, to - c2);
    const int steps = std::clamp(static_cast<int>(std::ceil(turn / kStep_rad)), 1, kMaxSteps);
    for (int i = 1; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps, s = 1 - t;
      Add(s * s * s * from + 3 * s * s * t * c1 + 3 * s * t * t * c2 + t * t * t * to);
    }
    Add(to);
    at_ = to;
    last_control_ = c2;
  }

  // From end points to a center: SVG 1.1, F.6.5.
  bool EllipticArc(const Vector2d& origin) {
    const auto rx = scanner_.Number(), ry = scanner_.Number(), turn = scanner_.Number();
    const auto large = scanner_.Flag(), sweep = scanner_.Flag();
    const auto x = scanner_.Number(), y = scanner_.Number();
    if (!rx || !ry || !turn || !large || !sweep || !x || !y) return false;
    last_ = 'A';
    const Vector2d to = origin + Vector2d(*x, *y), from = at_;
    Vector2d r(std::abs(*rx), std::abs(*ry));
    if (r.minCoeff() <= 0 || (to - from).norm() <= 0) return LineTo(to), true;
    const double angle = *turn * kPi / 180;
    const Vector2d half = 0.5 * (from - to);
    const Vector2d p(std::cos(angle) * half.x() + std::sin(angle) * half.y(), -std::sin(angle) * half.x() + std::cos(angle) * half.y());
    const double size = p.cwiseQuotient(r).squaredNorm();
    if (size > 1) r *= std::sqrt(size);
    const double d = Vector2d(r.x() * p.y(), r.y() * p.x()).squaredNorm();
    const double reach = std::sqrt(std::max(0.0, (r.x() * r.y() * r.x() * r.y() - d) / d)) * (*large == *sweep ? -1 : 1);
    const Vector2d c = reach * Vector2d(r.x() * p.y() / r.y(), -r.y() * p.x() / r.x());
    const Vector2d center = OnEllipse(0.5 * (from + to), {c.norm(), c.norm()}, angle, std::atan2(c.y(), c.x()));
    const double start = std::atan2((p.y() - c.y()) / r.y(), (p.x() - c.x()) / r.x());
    double swept = std::atan2((-p.y() - c.y()) / r.y(), (-p.x() - c.x()) / r.x()) - start;
    if (*sweep && swept < 0) swept += 2 * kPi;
    if (!*sweep && swept > 0) swept -= 2 * kPi;
    if (outline_.points.empty()) Add(from);
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(swept) / kStep_rad)));
    for (int i = 1; i < steps; ++i) Add(OnEllipse(center, r, angle, start + swept * i / steps));
    Add(to);
    at_ = last_control_ = to;
    return true;
  }

  void Add(const Vector2d& p) {
    ++points_;
    if (outline_.points.empty() || outline_.points.back() != p) outline_.points.push_back(p);
  }

  // Relative steps that are rounded each do not lead back to the very start.
  void Finish(bool closed) {
    Eigen::AlignedBox2d box;
    for (const Vector2d& p : outline_.points) box.extend(p);
    const size_t size = outline_.points.size();
    if (size > 2 && (outline_.points.front() - outline_.points.back()).norm() <= (size > 3 ? kCloses * box.diagonal().norm() : 0)) {
      outline_.points.pop_back();
      closed = true;
    }
    outline_.closed = closed && outline_.points.size() > 2;
    if (outline_.points.size() > 1) out_.outlines.push_back(std::move(outline_));
    outline_ = {};
  }

  SvgScanner scanner_;
  size_t max_points_, points_ = 0;
  SvgPathData out_;
  SvgOutline outline_;
  Vector2d at_ = Vector2d::Zero(), start_ = Vector2d::Zero(), last_control_ = Vector2d::Zero();
  char last_ = 0;
  bool started_ = false;
};

}  // namespace

SvgPathData ParseSvgPath(std::string_view data, size_t max_points) { return PathReader(data, max_points).Run(); }

SvgOutline SvgRect(double x, double y, double width, double height, double rx, double ry) {
  SvgOutline out;
  out.closed = true;
  rx = std::clamp(rx, 0.0, 0.5 * width);
  ry = std::clamp(ry, 0.0, 0.5 * height);
  if (rx <= 0 || ry <= 0) {
    out.points = {{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}};
    return out;
  }
  const Vector2d centers[] = {{x + width - rx, y + ry}, {x + width - rx, y + height - ry}, {x + rx, y + height - ry}, {x + rx, y + ry}};
  for (int corner = 0; corner < 4; ++corner) {
    for (int i = 0; i <= 24; ++i) out.points.push_back(OnEllipse(centers[corner], {rx, ry}, 0, (corner - 1) * 0.5 * kPi + i * kStep_rad));
  }
  return out;
}

SvgOutline SvgEllipse(double cx, double cy, double rx, double ry) {
  SvgOutline out;
  out.closed = true;
  for (int i = 0; i < 96; ++i) out.points.push_back(OnEllipse({cx, cy}, {rx, ry}, 0, i * kStep_rad));
  return out;
}

}  // namespace plumb::compiler
