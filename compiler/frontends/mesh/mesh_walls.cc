#include "compiler/frontends/mesh/mesh_walls.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "compiler/frontends/mesh/mesh_curve_gaps.h"
#include "compiler/frontends/mesh/mesh_facets.h"
#include "compiler/frontends/mesh/mesh_wall_gaps.h"
#include "compiler/frontends/mesh/mesh_wall_grid.h"
#include "compiler/frontends/mesh/mesh_wall_set.h"

namespace plumb::compiler {
namespace {

using Eigen::Vector2d;

constexpr double kMaxOpening_m = 8.0;      // wider ones under a lintel or over a sill part nothing
constexpr double kMaxSpannedDoor_m = 1.5;  // a lintel between flanks, without any wall beside the door
constexpr double kMinSill_m = 0.15;        // of a band of windows
constexpr double kMinSheet_m = 0.5, kMinLength_m = 0.05, kMinLoose_m = 0.1;
constexpr double kMaxParapetThickness_m = 0.35;
constexpr double kMaxColumn_m = 0.8;
constexpr double kMinFacetCosine = 0.87;  // between two facets of a curve

// A stretch of a grid that no wall covers and nothing holds up.
struct LooseColumns {
  const WallGrid* grid = nullptr;
  Columns columns;
};

class WallFinder {
 public:
  WallFinder(const std::vector<double>& breaks_m, const StoreyRange& range, const MeshOptions& options,
             std::vector<FaceDirection>& directions)
      : directions_(directions), walls_(directions), breaks_m_(breaks_m), range_(range), options_(options) {}

  std::vector<WallPiece> Run(const std::vector<Band>& bands) {
    for (const Band& band : bands) {
      if (!band.sheet) grids_.emplace_back(band, breaks_m_, range_);
    }
    HoldFacets(walls_.directions(), kMaxOpening_m, grids_);
    for (const WallGrid& grid : grids_) AddCores(grid, kMinLength_m);
    walls_.DropContained();
    AddSheets(bands);
    walls_.DropContained();
    AddLooseRuns();
    AlignPiers();
    CloseGapsInLine(options_, walls_);
    CloseGapsInCurves(options_, directions_, walls_.pieces);
    CloseGapsToFlanks(options_, walls_);
    walls_.DropContained();
    DropFilledVoids();
    MarkColumns();
    CloseCavities(options_, walls_);
    return std::move(walls_.pieces);
  }

 private:
  // From core to core, across what is under lintels and over sills.
  void AddCores(const WallGrid& grid, double min_length_m) {
    std::optional<Columns> open;
    const auto flush = [&] {
      if (open) {
        WallPiece piece = grid.Piece(*open);
        if (piece.length_m() >= min_length_m) walls_.pieces.push_back(std::move(piece));
      }
      open.reset();
    };
    for (size_t j = 0; j < grid.size(); ++j) {
      if (grid.state(j) == WallState::kEmpty) flush();
      if (grid.state(j) != WallState::kCore && grid.state(j) != WallState::kHeld) continue;
      if (open && grid.Start(j) - grid.End(open->last) > kMaxOpening_m) flush();
      if (!open) open = {j, j};
      open->last = j;
    }
    flush();
  }

  void AddSheets(const std::vector<Band>& bands) {
    std::vector<WallGrid> sheets;
    for (const Band& band : bands) {
      if (band.sheet) sheets.emplace_back(band, breaks_m_, range_);
    }
    for (WallGrid& sheet : sheets) {
      HideInWalls(sheet);
      AddCores(sheet, kMinSheet_m);
    }
  }

  // What is a face of a wall that is known already is no wall of its own.
  void HideInWalls(WallGrid& sheet) const {
    const Band& b = sheet.band();
    const FaceDirection& d = walls_.directions()[b.direction];
    for (size_t j = 0; j < sheet.size(); ++j) {
      const bool hidden = std::any_of(walls_.pieces.begin(), walls_.pieces.end(), [&](const WallPiece& p) {
        if (p.sheet) return false;
        for (const double c : {b.c0_m, 0.5 * (b.c0_m + b.c1_m), b.c1_m}) {
          if (walls_.Holds(p, d.At(sheet.Middle(j), c), kWallProbe_m)) return true;
        }
        return false;
      });
      if (hidden) sheet.Hide(j);
    }
  }

  // Ends of lintels and sills that reach another wall, lintels between two flanks, bands of windows, parapets.
  void AddLooseRuns() {
    std::vector<LooseColumns> runs;
    for (const WallGrid& grid : grids_) {
      for (size_t j = 0; j < grid.size(); ++j) {
        if (!IsLoose(grid, j)) continue;
        Columns run{j, j};
        while (run.last + 1 < grid.size() && IsLoose(grid, run.last + 1)) ++run.last;
        j = run.last;
        runs.push_back({&grid, run});
      }
    }
    std::vector<WallPiece> found;
    for (const LooseColumns& run : runs) {
      if (std::optional<WallPiece> piece = LooseRun(run)) found.push_back(std::move(*piece));
    }
    AddWindowBands(runs, found);
    for (WallPiece& p : found) walls_.pieces.push_back(std::move(p));
  }

  bool IsLoose(const WallGrid& grid, size_t j) const {
    if (grid.state(j) != WallState::kPartial) return false;
    const Band& b = grid.band();
    const Vector2d at = walls_.directions()[b.direction].At(grid.Middle(j), 0.5 * (b.c0_m + b.c1_m));
    return walls_.PieceAt(at, nullptr, kWallWeld_m) == nullptr;
  }

  std::optional<WallPiece> LooseRun(const LooseColumns& run) const {
    WallPiece piece = run.grid->Piece(run.columns);
    if (piece.length_m() < kMinLoose_m) return std::nullopt;
    const WallSet::Touches touches = walls_.TouchesOf(piece, walls_.pieces);
    if (touches.any == 3 && piece.length_m() <= (touches.in_line != 0 ? kMaxOpening_m : kMaxSpannedDoor_m)) {
      OpenUnderAndOver(piece);
      return piece;
    }
    const bool low = run.grid->HasSill(run.columns, options_.min_parapet_height_m) && piece.thickness_m() <= kMaxParapetThickness_m &&
                     piece.length_m() >= kMinSheet_m;
    if (touches.any == 0 || !low) return std::nullopt;
    return run.grid->Parapet(run.columns, range_.floor_z_m + std::max(kWallHeight_m, options_.section_height_m + kMinWallGap_m));
  }

  // A lintel or a sill between walls makes a wall with them that is open from the floor to it, or from it to their top.
  void OpenUnderAndOver(WallPiece& piece) const {
    if (piece.length_m() < kMinSheet_m) return;
    if (piece.z0_m > range_.floor_z_m + kMinLoose_m) {
      piece.voids.push_back({piece.span, range_.floor_z_m, piece.z0_m});
      piece.z0_m = range_.floor_z_m;
    } else if (piece.z1_m < range_.floor_z_m + kWallHeight_m) {
      piece.voids.push_back({piece.span, piece.z1_m, range_.top_z_m});
      piece.z1_m = range_.top_z_m;
    }
  }

  // Walls that are windows from end to end, with a sill and a lintel, if they reach other walls or each other.
  void AddWindowBands(const std::vector<LooseColumns>& runs, std::vector<WallPiece>& found) const {
    std::vector<WallPiece> bands;
    for (const LooseColumns& run : runs) {
      if (run.grid->HasSill(run.columns, kMinSill_m) && run.grid->HasLintel(run.columns, range_.floor_z_m + options_.section_height_m))
        bands.push_back(run.grid->Piece(run.columns));
    }
    for (bool changed = true; changed;) {
      const size_t before = bands.size();
      for (size_t i = 0; i < bands.size(); ++i) {
        const int touches =
            walls_.TouchesOf(bands[i], walls_.pieces).any | walls_.TouchesOf(bands[i], found).any | walls_.TouchesOf(bands[i], bands).any;
        if (touches != 3) bands.erase(bands.begin() + static_cast<std::ptrdiff_t>(i--));
      }
      changed = bands.size() != before;
    }
    for (WallPiece& p : bands) {
      const bool known = std::any_of(found.begin(), found.end(), [&](const WallPiece& f) { return walls_.IsWithin(p, f); });
      if (!known) found.push_back(std::move(p));
    }
  }

  // Piers have no direction of their own: they lie in the line of another wall, else along their longer side.
  void AlignPiers() {
    for (WallPiece& p : walls_.pieces) {
      if (p.sheet || !p.voids.empty() || std::max(p.length_m(), p.thickness_m()) > kMaxColumn_m || HasPartner(p) || GoesOnAskew(p))
        continue;
      const std::optional<WallPiece> turned = walls_.Turned(p);
      if (turned && (p.length_m() < p.thickness_m() || HasPartner(*turned))) p = *turned;
    }
  }

  // A facet of a curve: the next one begins where it ends, turned a little.
  bool GoesOnAskew(const WallPiece& p) const {
    const FaceDirection& d = walls_.directions()[p.direction];
    return std::any_of(walls_.pieces.begin(), walls_.pieces.end(), [&](const WallPiece& q) {
      const FaceDirection& e = walls_.directions()[q.direction];
      const double cosine = std::abs(d.along.dot(e.along));
      if (q.direction == p.direction || cosine < kMinFacetCosine || std::abs(q.thickness_m() - p.thickness_m()) > kWallLine_m) return false;
      for (const double s : {p.span.s0_m, p.span.s1_m}) {
        for (const double t : {q.span.s0_m, q.span.s1_m}) {
          const Vector2d gap = walls_.At(p, s, 0.5 * (p.c0_m + p.c1_m)) - walls_.At(q, t, 0.5 * (q.c0_m + q.c1_m));
          if (gap.norm() < kWallLine_m + 0.5 * p.thickness_m() * std::sqrt(1 - cosine * cosine)) return true;
        }
      }
      return false;
    });
  }

  bool HasPartner(const WallPiece& p) const {
    return std::any_of(walls_.pieces.begin(), walls_.pieces.end(), [&](const WallPiece& q) {
      const double gap_m = std::max(q.span.s0_m - p.span.s1_m, p.span.s0_m - q.span.s1_m);
      return WallSet::IsInLine(p, q) && gap_m >= kMinWallGap_m && gap_m <= options_.max_free_gap_m;
    });
  }

  // Where a wall changes its thickness the next one stands in what is missing of it.
  void DropFilledVoids() {
    for (WallPiece& p : walls_.pieces) {
      std::erase_if(p.voids, [&](const WallVoid& v) {
        for (const double u : {0.1, 0.5, 0.9}) {
          const Vector2d at = walls_.At(p, v.span.s0_m + u * (v.span.s1_m - v.span.s0_m), 0.5 * (p.c0_m + p.c1_m));
          if (std::none_of(walls_.pieces.begin(), walls_.pieces.end(),
                           [&](const WallPiece& q) { return &p != &q && IsSolidAt(q, at, 0.5 * (v.z0_m + v.z1_m)); }))
            return false;
        }
        return true;
      });
    }
  }

  bool IsSolidAt(const WallPiece& q, const Vector2d& at, double z_m) const {
    if (!walls_.Holds(q, at, 0)) return false;
    const double s_m = walls_.directions()[q.direction].S(at);
    return std::none_of(q.voids.begin(), q.voids.end(),
                        [&](const WallVoid& v) { return s_m >= v.span.s0_m && s_m <= v.span.s1_m && z_m >= v.z0_m && z_m <= v.z1_m; });
  }

  void MarkColumns() {
    for (WallPiece& p : walls_.pieces) {
      p.column = !p.sheet && !p.parapet && p.closed_gaps == 0 && p.length_m() <= kMaxColumn_m && p.length_m() <= 3 * p.thickness_m() &&
                 walls_.IsFree(p, 1) && walls_.IsFree(p, -1) && !walls_.IsCorner(p, 1) && !walls_.IsCorner(p, -1);
    }
  }

  std::vector<FaceDirection>& directions_;
  WallSet walls_;
  const std::vector<double>& breaks_m_;
  const StoreyRange range_;
  const MeshOptions& options_;
  std::vector<WallGrid> grids_;  // of bands with two faces
};

}  // namespace

std::vector<WallPiece> FindWalls(const std::vector<Band>& bands, const std::vector<double>& breaks_m, const StoreyRange& range,
                                 const MeshOptions& options, std::vector<FaceDirection>& directions) {
  return WallFinder(breaks_m, range, options, directions).Run(bands);
}

}  // namespace plumb::compiler
