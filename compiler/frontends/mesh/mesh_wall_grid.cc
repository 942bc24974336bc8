#include "compiler/frontends/mesh/mesh_wall_grid.h"

#include <algorithm>
#include <cmath>

namespace plumb::compiler {
namespace {

constexpr double kCoreShare = 0.85;  // of the height that walls stand to
constexpr double kMaxFoot_m = 0.15;  // a wall may begin this far above the floor
constexpr double kSameHeight_m = 0.05;
constexpr double kMinVoid_m = 0.1;

// Columns that differ elsewhere only: one opening.
void MergeVoids(std::vector<WallVoid>& voids) {
  std::vector<WallVoid> merged;
  for (const WallVoid& v : voids) {
    const auto left = std::find_if(merged.begin(), merged.end(), [&](const WallVoid& m) {
      return std::abs(m.span.s1_m - v.span.s0_m) <= kWallWeld_m && std::abs(m.z0_m - v.z0_m) <= kSameHeight_m &&
             std::abs(m.z1_m - v.z1_m) <= kSameHeight_m;
    });
    if (left != merged.end())
      left->span.s1_m = v.span.s1_m;
    else
      merged.push_back(v);
  }
  voids = std::move(merged);
}

}  // namespace

WallGrid::WallGrid(const Band& band, const std::vector<double>& breaks_m, const StoreyRange& range)
    : band_(&band), breaks_m_(&breaks_m), range_(range) {
  std::vector<double> ends;
  for (const auto& spans : band.spans) {
    for (const Span& s : spans) ends.insert(ends.end(), {s.s0_m, s.s1_m});
  }
  std::sort(ends.begin(), ends.end());
  for (const double s : ends) {
    if (s_m_.empty() || s > s_m_.back() + kWallWeld_m) s_m_.push_back(s);
  }
  const size_t columns = s_m_.empty() ? 0 : s_m_.size() - 1;
  solid_.assign(columns, std::vector<char>(band.spans.size(), 0));
  for (size_t k = 0; k < band.spans.size(); ++k) {
    for (const Span& s : band.spans[k]) {
      for (size_t j = 0; j < columns; ++j) {
        if (Middle(j) > s.s0_m && Middle(j) < s.s1_m) solid_[j][k] = 1;
      }
    }
  }
  for (size_t j = 0; j < columns; ++j) AddState(j);
}

void WallGrid::AddState(size_t column) {
  const double reference_m = std::min(kWallHeight_m, range_.top_z_m - range_.floor_z_m);
  double stands_m = 0, low_m = 0;
  bool any = false, broken = false;
  for (size_t k = 0; k < solid_[column].size(); ++k) {
    const double z0 = (*breaks_m_)[k] - range_.floor_z_m, z1 = (*breaks_m_)[k + 1] - range_.floor_z_m;
    if (solid_[column][k] != 0) {
      any = true;
      stands_m += std::max(0.0, std::min(z1, reference_m) - std::max(z0, 0.0));
      if (!broken) low_m = z1;
    } else if (z1 > kMaxFoot_m) {
      broken = true;
    }
  }
  state_.push_back(!any ? WallState::kEmpty : stands_m >= kCoreShare * reference_m ? WallState::kCore : WallState::kPartial);
  low_m_.push_back(low_m);
}

bool WallGrid::HasSill(const Columns& run, double height_m) const {
  return std::all_of(low_m_.begin() + static_cast<std::ptrdiff_t>(run.first), low_m_.begin() + static_cast<std::ptrdiff_t>(run.last) + 1,
                     [&](double low_m) { return low_m >= height_m; });
}

bool WallGrid::HasLintel(const Columns& run, double z_m) const {
  for (size_t j = run.first; j <= run.last; ++j) {
    bool lintel = false;
    for (size_t k = 0; k < solid_[j].size(); ++k) lintel |= solid_[j][k] != 0 && (*breaks_m_)[k] > z_m;
    if (!lintel) return false;
  }
  return true;
}

WallPiece WallGrid::Outline(const Columns& run) const {
  WallPiece out;
  out.direction = band_->direction;
  out.c0_m = band_->c0_m;
  out.c1_m = band_->c1_m;
  out.group = band_->group;
  out.sheet = band_->sheet;
  out.span = {s_m_[run.first], s_m_[run.last + 1]};
  out.z0_m = range_.top_z_m;
  out.z1_m = range_.floor_z_m;
  for (size_t j = run.first; j <= run.last; ++j) {
    for (size_t k = 0; k < solid_[j].size(); ++k) {
      if (solid_[j][k] == 0) continue;
      out.z0_m = std::min(out.z0_m, (*breaks_m_)[k]);
      out.z1_m = std::max(out.z1_m, (*breaks_m_)[k + 1]);
    }
  }
  // What holds these columns stands on the floor.
  const auto state = state_.begin() + static_cast<std::ptrdiff_t>(run.first);
  if (std::find(state, state + static_cast<std::ptrdiff_t>(run.last - run.first + 1), WallState::kHeld) != state + static_cast<std::ptrdiff_t>(run.last - run.first + 1)) {
    out.z0_m = std::min(out.z0_m, range_.floor_z_m);
    if (out.z1_m < range_.floor_z_m + kWallHeight_m) out.z1_m = range_.top_z_m;
  }
  return out;
}

WallPiece WallGrid::Piece(const Columns& run) const {
  WallPiece out = Outline(run);
  AddVoids(run, out);
  return out;
}

WallPiece WallGrid::Parapet(const Columns& run, double top_z_m) const {
  WallPiece out = Outline(run);
  out.parapet = true;
  out.z1_m = std::max(out.z1_m, top_z_m);
  return out;
}

void WallGrid::AddVoids(const Columns& run, WallPiece& out) const {
  for (size_t j = run.first; j <= run.last;) {
    size_t end = j + 1;
    while (end <= run.last && solid_[end] == solid_[j]) ++end;
    AddVoidsOfColumns(j, end, out);
    j = end;
  }
  MergeVoids(out.voids);
}

void WallGrid::AddVoidsOfColumns(size_t first, size_t end, WallPiece& out) const {
  const std::vector<char>& solid = solid_[first];
  const Span span{s_m_[first], s_m_[end]};
  // At an end the opening may go on in the next facet of a curve.
  const bool at_end = span.s0_m <= out.span.s0_m || span.s1_m >= out.span.s1_m;
  if (span.s1_m - span.s0_m < kMinVoid_m && !at_end) return;
  for (size_t k = 0; k < solid.size();) {
    size_t above = k + 1;
    while (above < solid.size() && solid[above] == solid[k]) ++above;
    const double z0 = std::max((*breaks_m_)[k], out.z0_m), z1 = std::min((*breaks_m_)[above], out.z1_m);
    // Above a core it is the slope of a gable.
    const bool gable = z1 >= out.z1_m - kWallWeld_m && state_[first] == WallState::kCore;
    if (solid[k] == 0 && z1 - z0 >= kMinVoid_m && !gable) out.voids.push_back({span, z0, z1});
    k = above;
  }
}

}  // namespace plumb::compiler
