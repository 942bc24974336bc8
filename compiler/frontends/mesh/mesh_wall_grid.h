// A band of wall over its length and height, cell by cell: which stretches stand as a wall, what is over and under its openings.
#pragma once

#include <vector>

#include "compiler/frontends/mesh/mesh_walls.h"

namespace plumb::compiler {

// Core: stands from the floor as high as walls do. Held: open below or above, between parts of the same wall.
enum class WallState : uint8_t { kEmpty, kPartial, kHeld, kCore };

// Columns from first to last, both included.
struct Columns {
  size_t first = 0, last = 0;
};

class WallGrid {
 public:
  // Both must outlive it. `breaks_m`: as for FindWalls. Columns begin and end where the band does at any height.
  WallGrid(const Band& band, const std::vector<double>& breaks_m, const StoreyRange& range);

  [[nodiscard]] const Band& band() const { return *band_; }
  [[nodiscard]] size_t size() const { return state_.size(); }
  [[nodiscard]] WallState state(size_t column) const { return state_[column]; }
  void Hide(size_t column) { state_[column] = WallState::kEmpty; }
  void Hold(size_t column) { state_[column] = WallState::kHeld; }
  [[nodiscard]] double Start(size_t column) const { return s_m_[column]; }
  [[nodiscard]] double End(size_t column) const { return s_m_[column + 1]; }
  [[nodiscard]] double Middle(size_t column) const { return 0.5 * (s_m_[column] + s_m_[column + 1]); }

  // Solid from the floor to this height, everywhere.
  [[nodiscard]] bool HasSill(const Columns& run, double height_m) const;
  // Something above z, everywhere: with a sill below, a band of windows.
  [[nodiscard]] bool HasLintel(const Columns& run, double z_m) const;

  // The wall with what is open in it.
  [[nodiscard]] WallPiece Piece(const Columns& run) const;
  // A low wall, raised to top_z.
  [[nodiscard]] WallPiece Parapet(const Columns& run, double top_z_m) const;

 private:
  void AddState(size_t column);
  [[nodiscard]] WallPiece Outline(const Columns& run) const;
  void AddVoids(const Columns& run, WallPiece& out) const;
  void AddVoidsOfColumns(size_t first, size_t end, WallPiece& out) const;

  const Band* band_;
  const std::vector<double>* breaks_m_;
  StoreyRange range_;
  std::vector<double> s_m_;               // one more than columns
  std::vector<std::vector<char>> solid_;  // by column and slice
  std::vector<WallState> state_;
  std::vector<double> low_m_;  // how high the column stands from the floor without a gap
};

}  // namespace plumb::compiler
