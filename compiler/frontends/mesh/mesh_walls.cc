#include "compiler/frontends/mesh/mesh_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kWeld_m = 0.005;          // places along a wall closer than this are one
constexpr double kReference_m = 2.0;       // what stands from the floor to here is a wall, whatever is above
constexpr double kCoreShare = 0.85;        // ... but for this much of it
constexpr double kMaxFoot_m = 0.15;        // a wall may begin this far above the floor
constexpr double kMaxOpening_m = 8.0;      // wider ones under a lintel or over a sill part nothing
constexpr double kMaxSpannedDoor_m = 1.5;  // a lintel between flanks, without any wall beside the door
constexpr double kTouch_m = 0.05;
constexpr double kSameLine_m = 0.03;  // faces of walls in one line
constexpr double kMinGap_m = 0.05;    // smaller ones are bridged by the passes
constexpr double kMinDoorGap_m = 0.5;
constexpr double kMinSheet_m = 0.5, kMinLength_m = 0.05;
constexpr double kMaxParapetThickness_m = 0.35;
constexpr double kMaxColumn_m = 0.8;
constexpr double kMinVoid_m = 0.1;
constexpr double kStep_m = 0.02;
constexpr double kMaxCavity_m = 0.35, kCavityShare = 0.8;  // between skins of one wall; of the shorter one's length

enum class State : uint8_t { kEmpty, kPartial, kCore };

// A band over its length and height, cell by cell.
struct Grid {
  const Band* band = nullptr;
  std::vector<double> s_m;               // one more than columns
  std::vector<std::vector<char>> solid;  // by column and slice
  std::vector<State> state;
  std::vector<double> low_m;  // how high the column stands from the floor without a gap
  [[nodiscard]] size_t size() const { return state.size(); }
  [[nodiscard]] double Width(size_t j) const { return s_m[j + 1] - s_m[j]; }
};

// Columns from first to last, both included.
struct Columns {
  size_t grid = 0, first = 0, last = 0;
};

class WallFinder {
 public:
  WallFinder(const std::vector<FaceDirection>& directions, const std::vector<double>& breaks_m, const StoreyRange& range,
             const MeshOptions& options)
      : directions_(directions), breaks_m_(breaks_m), range_(range), options_(options) {}

  std::vector<WallPiece> Run(const std::vector<Band>& bands) {
    for (const Band& band : bands) {
      if (!band.sheet) grids_.push_back(MakeGrid(band));
    }
    for (size_t g = 0; g < grids_.size(); ++g) AddCores(g, kMinLength_m);
    DropContained();
    const size_t first_sheet = grids_.size();
    for (const Band& band : bands) {
      if (band.sheet) grids_.push_back(MakeGrid(band));
    }
    for (size_t g = first_sheet; g < grids_.size(); ++g) {
      HideInWalls(grids_[g]);
      AddCores(g, kMinSheet_m);
    }
    DropContained();
    AddLooseRuns();
    AlignPiers();
    CloseGapsInLine();
    CloseGapsToFlanks();
    DropContained();
    DropFilledVoids();
    MarkColumns();
    CloseCavities();
    return std::move(pieces_);
  }

 private:
  Grid MakeGrid(const Band& band) const {
    Grid g;
    g.band = &band;
    std::vector<double> ends;
    for (const auto& spans : band.spans) {
      for (const Span& s : spans) ends.insert(ends.end(), {s.s0_m, s.s1_m});
    }
    std::sort(ends.begin(), ends.end());
    for (const double s : ends) {
      if (g.s_m.empty() || s > g.s_m.back() + kWeld_m) g.s_m.push_back(s);
    }
    const size_t columns = g.s_m.empty() ? 0 : g.s_m.size() - 1;
    g.solid.assign(columns, std::vector<char>(band.spans.size(), 0));
    for (size_t k = 0; k < band.spans.size(); ++k) {
      for (const Span& s : band.spans[k]) {
        for (size_t j = 0; j < columns; ++j) {
          const double middle = 0.5 * (g.s_m[j] + g.s_m[j + 1]);
          if (middle > s.s0_m && middle < s.s1_m) g.solid[j][k] = 1;
        }
      }
    }
    for (size_t j = 0; j < columns; ++j) AddState(g, j);
    return g;
  }

  void AddState(Grid& g, size_t j) const {
    const double reference_m = std::min(kReference_m, range_.top_z_m - range_.floor_z_m);
    double stands_m = 0, low_m = 0;
    bool any = false, broken = false;
    for (size_t k = 0; k < g.solid[j].size(); ++k) {
      const double z0 = breaks_m_[k] - range_.floor_z_m, z1 = breaks_m_[k + 1] - range_.floor_z_m;
      if (g.solid[j][k] != 0) {
        any = true;
        stands_m += std::max(0.0, std::min(z1, reference_m) - std::max(z0, 0.0));
        if (!broken) low_m = z1;
      } else if (z1 > kMaxFoot_m) {
        broken = true;
      }
    }
    g.state.push_back(!any ? State::kEmpty : stands_m >= kCoreShare * reference_m ? State::kCore : State::kPartial);
    g.low_m.push_back(low_m);
  }

  // What is a face of a wall that is known already is no wall of its own.
  void HideInWalls(Grid& g) const {
    const Band& b = *g.band;
    const FaceDirection& d = directions_[b.direction];
    for (size_t j = 0; j < g.size(); ++j) {
      const double s = 0.5 * (g.s_m[j] + g.s_m[j + 1]);
      const bool hidden = std::any_of(pieces_.begin(), pieces_.end(), [&](const WallPiece& p) {
        if (p.sheet) return false;
        for (const double c : {b.c0_m, 0.5 * (b.c0_m + b.c1_m), b.c1_m}) {
          if (p.Contains(directions_[p.direction], d.At(s, c), kStep_m)) return true;
        }
        return false;
      });
      if (hidden) g.state[j] = State::kEmpty;
    }
  }

  WallPiece PieceOf(const Span& span, size_t grid, bool parapet) const {
    const Grid& g = grids_[grid];
    WallPiece out;
    out.direction = g.band->direction;
    out.c0_m = g.band->c0_m;
    out.c1_m = g.band->c1_m;
    out.group = g.band->group;
    out.sheet = g.band->sheet;
    out.parapet = parapet;
    out.span = span;
    return out;
  }

  WallPiece MakePiece(const Columns& run, bool parapet) const {
    const Grid& g = grids_[run.grid];
    WallPiece out = PieceOf({g.s_m[run.first], g.s_m[run.last + 1]}, run.grid, parapet);
    out.z0_m = range_.top_z_m;
    out.z1_m = range_.floor_z_m;
    for (size_t j = run.first; j <= run.last; ++j) {
      for (size_t k = 0; k < g.solid[j].size(); ++k) {
        if (g.solid[j][k] == 0) continue;
        out.z0_m = std::min(out.z0_m, breaks_m_[k]);
        out.z1_m = std::max(out.z1_m, breaks_m_[k + 1]);
      }
    }
    if (parapet)
      out.z1_m = std::max(out.z1_m, range_.floor_z_m + std::max(kReference_m, options_.section_height_m + kMinGap_m));
    else
      AddVoids(run, out);
    return out;
  }

  void AddVoids(const Columns& run, WallPiece& out) const {
    const Grid& g = grids_[run.grid];
    for (size_t j = run.first; j <= run.last;) {
      size_t end = j + 1;
      while (end <= run.last && g.solid[end] == g.solid[j]) ++end;
      AddVoidsOfColumns(g, j, end, out);
      j = end;
    }
    MergeVoids(out.voids);
  }

  // Columns that differ elsewhere only: one opening.
  static void MergeVoids(std::vector<WallVoid>& voids) {
    std::vector<WallVoid> merged;
    for (const WallVoid& v : voids) {
      const auto left = std::find_if(merged.begin(), merged.end(), [&](const WallVoid& m) {
        return std::abs(m.span.s1_m - v.span.s0_m) <= kWeld_m && std::abs(m.z0_m - v.z0_m) <= kTouch_m &&
               std::abs(m.z1_m - v.z1_m) <= kTouch_m;
      });
      if (left != merged.end())
        left->span.s1_m = v.span.s1_m;
      else
        merged.push_back(v);
    }
    voids = std::move(merged);
  }

  void AddVoidsOfColumns(const Grid& g, size_t first, size_t end, WallPiece& out) const {
    const std::vector<char>& solid = g.solid[first];
    const Span span{g.s_m[first], g.s_m[end]};
    if (span.s1_m - span.s0_m < kMinVoid_m) return;
    for (size_t k = 0; k < solid.size();) {
      size_t above = k + 1;
      while (above < solid.size() && solid[above] == solid[k]) ++above;
      const double z0 = std::max(breaks_m_[k], out.z0_m), z1 = std::min(breaks_m_[above], out.z1_m);
      // Above a core it is the slope of a gable.
      const bool gable = z1 >= out.z1_m - kWeld_m && g.state[first] == State::kCore;
      if (solid[k] == 0 && z1 - z0 >= kMinVoid_m && !gable) out.voids.push_back({span, z0, z1});
      k = above;
    }
  }

  // From core to core, across what is under lintels and over sills.
  void AddCores(size_t grid, double min_length_m) {
    const Grid& g = grids_[grid];
    std::optional<Columns> open;
    const auto flush = [&] {
      if (open) {
        WallPiece piece = MakePiece(*open, false);
        if (piece.length_m() >= min_length_m) pieces_.push_back(std::move(piece));
      }
      open.reset();
    };
    for (size_t j = 0; j < g.size(); ++j) {
      if (g.state[j] == State::kEmpty) flush();
      if (g.state[j] != State::kCore) continue;
      if (open && g.s_m[j] - g.s_m[open->last + 1] > kMaxOpening_m) flush();
      if (!open) open = {grid, j, j};
      open->last = j;
    }
    flush();
  }

  // Piers have no direction of their own: they lie in the line of another wall, else along their longer side.
  void AlignPiers() {
    for (WallPiece& p : pieces_) {
      if (p.sheet || !p.voids.empty() || std::max(p.length_m(), p.thickness_m()) > kMaxColumn_m || HasPartner(p)) continue;
      const std::optional<WallPiece> turned = Turned(p);
      if (turned && (p.length_m() < p.thickness_m() || HasPartner(*turned))) p = *turned;
    }
  }

  bool HasPartner(const WallPiece& p) const {
    return std::any_of(pieces_.begin(), pieces_.end(), [&](const WallPiece& q) {
      const double gap_m = std::max(q.span.s0_m - p.span.s1_m, p.span.s0_m - q.span.s1_m);
      return IsInLine(p, q) && gap_m >= kMinGap_m && gap_m <= options_.max_free_gap_m;
    });
  }

  static bool IsInLine(const WallPiece& p, const WallPiece& q) {
    return p.direction == q.direction && std::abs(p.c0_m - q.c0_m) <= kSameLine_m && std::abs(p.c1_m - q.c1_m) <= kSameLine_m;
  }

  // Seen along the direction square to its own, if the plan has it.
  std::optional<WallPiece> Turned(const WallPiece& p) const {
    const FaceDirection& d = directions_[p.direction];
    for (size_t i = 0; i < directions_.size(); ++i) {
      const FaceDirection& q = directions_[i];
      if (std::abs(q.along.dot(d.along)) > kWeld_m) continue;
      const Vector2d a = d.At(p.span.s0_m, p.c0_m), b = d.At(p.span.s1_m, p.c1_m);
      WallPiece out = p;
      out.direction = i;
      out.span = {std::min(q.S(a), q.S(b)), std::max(q.S(a), q.S(b))};
      out.c0_m = std::min(q.C(a), q.C(b));
      out.c1_m = std::max(q.C(a), q.C(b));
      return out;
    }
    return std::nullopt;
  }

  // Skins of one wall with a cavity between them: the inner one takes the cavity.
  void CloseCavities() {
    for (WallPiece& p : pieces_) {
      for (const WallPiece& q : pieces_) {
        if (&p == &q || p.direction != q.direction || p.sheet || q.sheet || p.length_m() > q.length_m() + kTouch_m) continue;
        const double common_m = std::min(p.span.s1_m, q.span.s1_m) - std::max(p.span.s0_m, q.span.s0_m);
        if (common_m < kCavityShare * p.length_m()) continue;
        const double above_m = q.c0_m - p.c1_m, below_m = p.c0_m - q.c1_m;
        const double gap_m = std::max(above_m, below_m);
        if (gap_m <= 0 || gap_m > kMaxCavity_m || p.thickness_m() + gap_m > 2 * options_.max_wall_thickness_m || IsCrossed(p, q, gap_m))
          continue;
        (above_m > 0 ? p.c1_m : p.c0_m) = above_m > 0 ? q.c0_m : q.c1_m;
      }
    }
  }

  // Something stands or opens in the gap: then it is no cavity but a passage or two walls.
  bool IsCrossed(const WallPiece& p, const WallPiece& q, double gap_m) const {
    const double c_m = q.c0_m > p.c1_m ? p.c1_m + 0.5 * gap_m : p.c0_m - 0.5 * gap_m;
    for (const double u : {0.1, 0.5, 0.9}) {
      if (PieceAt(At(p, p.span.s0_m + u * p.length_m(), c_m), nullptr, 0) != nullptr) return true;
    }
    return false;
  }

  [[nodiscard]] Vector2d At(const WallPiece& p, double s, double c) const { return directions_[p.direction].At(s, c); }

  [[nodiscard]] const WallPiece* PieceAt(const Vector2d& at, const WallPiece* but, double slack_m) const {
    for (const WallPiece& p : pieces_) {
      if (&p != but && p.Contains(directions_[p.direction], at, slack_m)) return &p;
    }
    return nullptr;
  }

  void DropContained() {
    std::vector<size_t> order(pieces_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto area = [&](size_t i) { return pieces_[i].length_m() * pieces_[i].thickness_m(); };
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
      if (pieces_[a].sheet != pieces_[b].sheet) return pieces_[b].sheet;
      const bool same = std::abs(area(a) - area(b)) < 1e-6 * area(a);
      return same ? pieces_[a].length_m() > pieces_[b].length_m() + kWeld_m : area(a) > area(b);
    });
    std::vector<bool> dropped(pieces_.size(), false);
    for (size_t i = 0; i < order.size(); ++i) {
      for (size_t k = 0; k < i && !dropped[order[i]]; ++k) {
        if (!dropped[order[k]] && IsWithin(pieces_[order[i]], pieces_[order[k]])) dropped[order[i]] = true;
      }
    }
    std::vector<WallPiece> kept;
    for (size_t i = 0; i < pieces_.size(); ++i) {
      if (!dropped[i]) kept.push_back(std::move(pieces_[i]));
    }
    pieces_ = std::move(kept);
  }

  bool IsWithin(const WallPiece& small, const WallPiece& large) const {
    const FaceDirection& d = directions_[large.direction];
    if (small.z1_m > large.z1_m + kReference_m) return false;
    for (const double u : {0.02, 0.25, 0.5, 0.75, 0.98}) {
      for (const double v : {0.02, 0.5, 0.98}) {
        const Vector2d p = At(small, small.span.s0_m + u * small.length_m(), small.c0_m + v * small.thickness_m());
        if (!large.Contains(d, p, small.sheet ? kStep_m : kWeld_m)) return false;
      }
    }
    return true;
  }

  // Ends of lintels and sills that reach another wall, lintels between two flanks, bands of windows, parapets.
  void AddLooseRuns() {
    std::vector<Columns> runs;
    for (size_t grid = 0; grid < grids_.size(); ++grid) {
      const Grid& g = grids_[grid];
      for (size_t j = 0; !g.band->sheet && j < g.size(); ++j) {
        if (g.state[j] != State::kPartial || IsWithinWall(g, j)) continue;
        Columns run{grid, j, j};
        while (run.last + 1 < g.size() && g.state[run.last + 1] == State::kPartial && !IsWithinWall(g, run.last + 1)) ++run.last;
        j = run.last;
        runs.push_back(run);
      }
    }
    std::vector<WallPiece> found;
    for (const Columns& run : runs) {
      if (std::optional<WallPiece> piece = LooseRun(run)) found.push_back(std::move(*piece));
    }
    AddWindowBands(runs, found);
    for (WallPiece& p : found) pieces_.push_back(std::move(p));
  }

  // Walls that are windows from end to end, with a sill and a lintel, if they reach other walls or each other.
  void AddWindowBands(const std::vector<Columns>& runs, std::vector<WallPiece>& found) const {
    std::vector<WallPiece> bands;
    for (const Columns& run : runs) {
      if (HasSill(run, kMaxFoot_m) && HasLintel(grids_[run.grid], run)) bands.push_back(MakePiece(run, false));
    }
    for (bool changed = true; changed;) {
      const size_t before = bands.size();
      for (size_t i = 0; i < bands.size(); ++i) {
        const int touches = TouchesOf(bands[i], pieces_).any | TouchesOf(bands[i], found).any | TouchesOf(bands[i], bands).any;
        if (touches != 3) bands.erase(bands.begin() + static_cast<long>(i--));
      }
      changed = bands.size() != before;
    }
    for (WallPiece& p : bands) {
      const bool known = std::any_of(found.begin(), found.end(), [&](const WallPiece& f) { return IsWithin(p, f); });
      if (!known) found.push_back(std::move(p));
    }
  }

  // Which ends of a piece others hold: 1 its start, 2 its end; and of these the ones held by walls in the same line.
  struct Touches {
    int any = 0, in_line = 0;
  };

  Touches TouchesOf(const WallPiece& piece, const std::vector<WallPiece>& others) const {
    Touches out;
    const double c_m = 0.5 * (piece.c0_m + piece.c1_m);
    for (const WallPiece& p : others) {
      if (&p == &piece) continue;
      const FaceDirection& q = directions_[p.direction];
      const int ends = (p.Contains(q, At(piece, piece.span.s0_m - kStep_m, c_m), kTouch_m) ? 1 : 0) |
                       (p.Contains(q, At(piece, piece.span.s1_m + kStep_m, c_m), kTouch_m) ? 2 : 0);
      out.any |= ends;
      if (IsInLine(p, piece)) out.in_line |= ends;
    }
    return out;
  }

  bool IsWithinWall(const Grid& g, size_t j) const {
    const FaceDirection& d = directions_[g.band->direction];
    return PieceAt(d.At(0.5 * (g.s_m[j] + g.s_m[j + 1]), 0.5 * (g.band->c0_m + g.band->c1_m)), nullptr, kWeld_m) != nullptr;
  }

  bool HasSill(const Columns& run, double height_m) const {
    const Grid& g = grids_[run.grid];
    return std::all_of(g.low_m.begin() + static_cast<long>(run.first), g.low_m.begin() + static_cast<long>(run.last) + 1,
                       [&](double low_m) { return low_m >= height_m; });
  }

  std::optional<WallPiece> LooseRun(const Columns& run) const {
    WallPiece piece = MakePiece(run, false);
    if (piece.length_m() < kMinVoid_m) return std::nullopt;
    const Touches touches = TouchesOf(piece, pieces_);
    if (touches.any == 3 && piece.length_m() <= (touches.in_line != 0 ? kMaxOpening_m : kMaxSpannedDoor_m)) return piece;
    const bool low =
        HasSill(run, options_.min_parapet_height_m) && piece.thickness_m() <= kMaxParapetThickness_m && piece.length_m() >= kMinSheet_m;
    if (touches.any != 0 && low) return MakePiece(run, true);
    return std::nullopt;
  }

  // Something above all of it: with a sill below, a band of windows.
  bool HasLintel(const Grid& g, const Columns& run) const {
    for (size_t j = run.first; j <= run.last; ++j) {
      bool lintel = false;
      for (size_t k = 0; k < g.solid[j].size(); ++k)
        lintel |= g.solid[j][k] != 0 && breaks_m_[k] > range_.floor_z_m + options_.section_height_m;
      if (!lintel) return false;
    }
    return true;
  }

  // `step`: +1 for the end, -1 for the start. Nothing goes on there.
  bool IsFree(const WallPiece& p, int step) const {
    const double s = step > 0 ? p.span.s1_m : p.span.s0_m;
    return PieceAt(At(p, s + step * kSameLine_m, 0.5 * (p.c0_m + p.c1_m)), &p, 0) == nullptr;
  }

  // Another wall meets it at its very end from the side.
  bool IsCorner(const WallPiece& p, int step) const {
    const double s = step > 0 ? p.span.s1_m : p.span.s0_m;
    for (const double c : {p.c0_m - kSameLine_m, p.c1_m + kSameLine_m}) {
      if (PieceAt(At(p, s - step * kStep_m, c), &p, 0) != nullptr) return true;
    }
    return false;
  }

  void CloseGapsInLine() {
    std::vector<size_t> order(pieces_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return pieces_[a].span.s0_m < pieces_[b].span.s0_m; });
    std::vector<bool> absorbed(pieces_.size(), false);
    for (size_t i = 0; i < order.size(); ++i) {
      if (absorbed[order[i]]) continue;
      WallPiece& p = pieces_[order[i]];
      for (size_t k = i + 1; k < order.size(); ++k) {
        const WallPiece& q = pieces_[order[k]];
        if (absorbed[order[k]] || !IsGapBetween(p, q)) continue;
        const Span gap{p.span.s1_m, q.span.s0_m};
        p.span.s1_m = gap.s1_m;
        p.voids.push_back({gap, std::min(p.z0_m, q.z0_m), std::max(p.z1_m, q.z1_m)});
        ++p.closed_gaps;
        if (p.group != q.group) break;
        absorbed[order[k]] = true;
        p.span.s1_m = q.span.s1_m;
        p.z0_m = std::min(p.z0_m, q.z0_m);
        p.z1_m = std::max(p.z1_m, q.z1_m);
        p.voids.insert(p.voids.end(), q.voids.begin(), q.voids.end());
        p.closed_gaps += q.closed_gaps;
      }
    }
    std::vector<WallPiece> kept;
    for (size_t i = 0; i < pieces_.size(); ++i) {
      if (!absorbed[i]) kept.push_back(std::move(pieces_[i]));
    }
    pieces_ = std::move(kept);
  }

  bool IsGapBetween(const WallPiece& p, const WallPiece& q) const {
    if (p.parapet != q.parapet || !IsInLine(p, q)) return false;
    const double gap_m = q.span.s0_m - p.span.s1_m;
    if (gap_m < kMinGap_m || gap_m > options_.max_free_gap_m || !IsFree(p, 1) || !IsFree(q, -1)) return false;
    if (gap_m > options_.max_door_gap_m && (IsCorner(p, 1) || IsCorner(q, -1))) return false;
    const double c = 0.5 * (p.c0_m + p.c1_m);
    for (double s = p.span.s1_m + kStep_m; s < q.span.s0_m - kStep_m; s += kTouch_m) {
      if (PieceAt(At(p, s, c), nullptr, 0) != nullptr) return false;
    }
    return true;
  }

  // A wall that ends a door's width before another one.
  void CloseGapsToFlanks() {
    for (WallPiece& p : pieces_) {
      if (p.column || p.length_m() < std::max(kMinDoorGap_m, 2 * p.thickness_m())) continue;
      for (const int step : {-1, 1}) {
        if (!IsFree(p, step) || IsCorner(p, step) || (IsFree(p, -step) && !IsCorner(p, -step))) continue;
        const double end = step > 0 ? p.span.s1_m : p.span.s0_m, c = 0.5 * (p.c0_m + p.c1_m);
        double gap_m = kMinGap_m;
        const WallPiece* flank = nullptr;
        while (gap_m <= options_.max_door_gap_m && (flank = PieceAt(At(p, end + step * gap_m, c), &p, 0)) == nullptr) gap_m += kStep_m;
        if (flank == nullptr || gap_m < kMinDoorGap_m) continue;
        const Span gap = step > 0 ? Span{end, end + gap_m} : Span{end - gap_m, end};
        (step > 0 ? p.span.s1_m : p.span.s0_m) = end + step * gap_m;
        p.voids.push_back({gap, p.z0_m, p.z1_m});
        ++p.closed_gaps;
      }
    }
  }

  // Where a wall changes its thickness the next one stands in what is missing of it.
  void DropFilledVoids() {
    for (WallPiece& p : pieces_) {
      std::erase_if(p.voids, [&](const WallVoid& v) {
        for (const double u : {0.1, 0.5, 0.9}) {
          const Vector2d at = At(p, v.span.s0_m + u * (v.span.s1_m - v.span.s0_m), 0.5 * (p.c0_m + p.c1_m));
          if (std::none_of(pieces_.begin(), pieces_.end(),
                           [&](const WallPiece& q) { return &p != &q && IsSolidAt(q, at, 0.5 * (v.z0_m + v.z1_m)); }))
            return false;
        }
        return true;
      });
    }
  }

  bool IsSolidAt(const WallPiece& q, const Vector2d& at, double z_m) const {
    const FaceDirection& d = directions_[q.direction];
    if (!q.Contains(d, at, 0)) return false;
    return std::none_of(q.voids.begin(), q.voids.end(), [&](const WallVoid& v) {
      return d.S(at) >= v.span.s0_m && d.S(at) <= v.span.s1_m && z_m >= v.z0_m && z_m <= v.z1_m;
    });
  }

  void MarkColumns() {
    for (WallPiece& p : pieces_) {
      p.column = !p.sheet && !p.parapet && p.closed_gaps == 0 && p.length_m() <= kMaxColumn_m && p.length_m() <= 3 * p.thickness_m() &&
                 IsFree(p, 1) && IsFree(p, -1) && !IsCorner(p, 1) && !IsCorner(p, -1);
    }
  }

  const std::vector<FaceDirection>& directions_;
  const std::vector<double>& breaks_m_;
  const StoreyRange range_;
  const MeshOptions& options_;
  std::vector<Grid> grids_;
  std::vector<WallPiece> pieces_;
};

}  // namespace

std::vector<WallPiece> FindWalls(const std::vector<FaceDirection>& directions, const std::vector<Band>& bands,
                                 const std::vector<double>& breaks_m, const StoreyRange& range, const MeshOptions& options) {
  return WallFinder(directions, breaks_m, range, options).Run(bands);
}

}  // namespace plumb::compiler
