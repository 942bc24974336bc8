// Pieces of walls by place: which of them hold a point, which end freely, which lie in others.
#pragma once

#include <optional>
#include <vector>

#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {

inline constexpr double kWallProbe_m = 0.02;  // how far beside a wall or beyond its end one looks
inline constexpr double kWallLine_m = 0.03;   // faces of walls in one line

class WallSet {
 public:
  // `directions` must outlive it.
  explicit WallSet(const std::vector<FaceDirection>& directions) : directions_(directions) {}

  std::vector<WallPiece> pieces;

  [[nodiscard]] const std::vector<FaceDirection>& directions() const { return directions_; }
  [[nodiscard]] Eigen::Vector2d At(const WallPiece& p, double s_m, double c_m) const { return directions_[p.direction].At(s_m, c_m); }
  [[nodiscard]] bool Holds(const WallPiece& p, const Eigen::Vector2d& at, double slack_m) const {
    return p.Contains(directions_[p.direction], at, slack_m);
  }
  // The first one but `but`; none: nullptr.
  [[nodiscard]] const WallPiece* PieceAt(const Eigen::Vector2d& at, const WallPiece* but, double slack_m) const;

  [[nodiscard]] static bool IsInLine(const WallPiece& p, const WallPiece& q);
  [[nodiscard]] bool IsWithin(const WallPiece& small, const WallPiece& large) const;

  // No other piece lies at s within p's thickness, a layer of it neither.
  [[nodiscard]] bool IsOpenAcross(const WallPiece& p, double s_m) const;
  // `step`: +1 for the end, -1 for the start. Nothing goes on there.
  [[nodiscard]] bool IsFree(const WallPiece& p, int step) const;
  // Another wall meets it at its very end from the side.
  [[nodiscard]] bool IsCorner(const WallPiece& p, int step) const;

  // Which ends of a piece others hold: 1 its start, 2 its end; and of these the ones held by walls in the same line.
  struct Touches {
    int any = 0, in_line = 0;
  };
  [[nodiscard]] Touches TouchesOf(const WallPiece& piece, const std::vector<WallPiece>& others) const;

  // Seen along the direction square to its own; none: the plan has no such direction.
  [[nodiscard]] std::optional<WallPiece> Turned(const WallPiece& p) const;

  // Drops what lies in larger ones.
  void DropContained();

 private:
  const std::vector<FaceDirection>& directions_;
};

}  // namespace plumb::compiler
