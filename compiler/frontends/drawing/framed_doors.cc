#include "compiler/frontends/drawing/framed_doors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "compiler/frontends/drawing/plane.h"

namespace plumb::compiler {
namespace {

constexpr double kTurn = 0.3, kSquare = 0.15;  // sine of a corner, cosine of a right angle
constexpr double kAlike = 0.3;                 // of a length
constexpr double kJog_m = 0.015;
constexpr size_t kMaxCorners = 64;             // around a face

using Quad = std::array<Eigen::Vector2d, 4>;

// The corners of an outline that is a quadrilateral but for jogs of the pen.
std::optional<Quad> QuadOf(std::vector<Eigen::Vector2d> ring) {
  if (ring.size() > kMaxCorners) return std::nullopt;
  std::vector<Eigen::Vector2d> coarse;
  for (const auto& p : ring) {
    if (coarse.empty() || (p - coarse.back()).norm() > kJog_m) coarse.push_back(p);
  }
  if (coarse.size() > 1 && (coarse.front() - coarse.back()).norm() <= kJog_m) coarse.pop_back();
  std::vector<Eigen::Vector2d> corners;
  for (size_t i = 0; i < coarse.size(); ++i) {
    const Eigen::Vector2d in = coarse[i] - coarse[(i + coarse.size() - 1) % coarse.size()], out = coarse[(i + 1) % coarse.size()] - coarse[i];
    if (std::abs(Cross(in.normalized(), out.normalized())) > kTurn) corners.push_back(coarse[i]);
  }
  if (corners.size() != 4) return std::nullopt;
  return Quad{corners[0], corners[1], corners[2], corners[3]};
}

class Finder {
 public:
  Finder(const Drawing& drawing, const WallMass& mass, const FramedDoorOptions& options) : drawing_(drawing), mass_(mass), map_(mass.map), options_(options) {}

  std::vector<DrawnOpening> Run() {
    std::vector<DrawnOpening> out;
    for (uint32_t f = 1; f < map_.num_faces(); ++f) {
      if (!mass_.is_wall[f] || map_.LoopsOf(f).size() != 1 || map_.AreaOf(f) > options_.max_width_m) continue;
      const std::optional<Quad> q = QuadOf(map_.RingAt(map_.LoopsOf(f)[0]));
      if (!q) continue;
      const Quad turned = {(*q)[1], (*q)[2], (*q)[3], (*q)[0]};
      for (const Quad& quad : {*q, turned}) {
        if (IsDoor(quad)) out.push_back(OpeningOf(f, quad));
      }
    }
    return out;
  }

 private:
  // Just beyond the side from `a` to `b` of an outline that runs counter-clockwise.
  uint32_t FaceBeyond(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
    return map_.FaceAt(0.5 * (a + b) - options_.beyond_m * Perp(b - a).normalized());
  }

  bool IsFrame(uint32_t face, double depth_m) const {
    if (!mass_.is_wall[face] || map_.LoopsOf(face).size() != 1) return false;
    const double width = LesserSide(map_.RingAt(map_.LoopsOf(face)[0]));
    return width >= options_.min_frame_m && width <= options_.max_frame_m && std::abs(map_.AreaOf(face) / width - depth_m) < kAlike * depth_m;
  }

  // Its ends, 0 to 1 and 2 to 3, are at frames, its other sides at free space.
  bool IsDoor(const Quad& q) const {
    const double depth = (q[1] - q[0]).norm(), width = (q[2] - q[1]).norm();
    if (width < options_.min_width_m || width > options_.max_width_m || std::abs(depth - (q[3] - q[2]).norm()) > kAlike * depth) return false;
    if (std::abs((q[1] - q[0]).normalized().dot((q[2] - q[1]).normalized())) > kSquare) return false;
    return IsFrame(FaceBeyond(q[0], q[1]), depth) && IsFrame(FaceBeyond(q[2], q[3]), depth) && !mass_.is_wall[FaceBeyond(q[1], q[2])] &&
           !mass_.is_wall[FaceBeyond(q[3], q[0])];
  }

  DrawnOpening OpeningOf(uint32_t face, const Quad& q) const {
    DrawnOpening out;
    out.from = 0.5 * (q[0] + q[1]);
    out.to = 0.5 * (q[2] + q[3]);
    out.depth_m = (q[1] - q[0]).norm();
    out.in_wall = true;
    const uint32_t source = map_.edges()[map_.LoopsOf(face)[0] / 2].source;
    if (source < drawing_.paths.size()) out.location = drawing_.paths[source].location;
    return out;
  }

  const Drawing& drawing_;
  const WallMass& mass_;
  const LineMap& map_;
  const FramedDoorOptions& options_;
};

}  // namespace

std::vector<DrawnOpening> FindFramedDoors(const Drawing& drawing, const WallMass& mass, const FramedDoorOptions& options) {
  return Finder(drawing, mass, options).Run();
}

}  // namespace plumb::compiler
