#include "runtime/rooms/wall_pieces.h"

#include <algorithm>
#include <cmath>

namespace plumb::runtime {
namespace {

constexpr double kColumn_m = 0.1;   // that of the surfaces' cells
constexpr double kMaxGap_m = 0.35;  // between seen cells of one piece; a door is wider
constexpr double kMinPiece_m = 0.2;
constexpr double kTall_m = 1.3;       // above the band's lower edge: no furniture that one could see over
constexpr double kBeyond_m = 0.3;     // a ray that got this far beyond a column went over it
constexpr int kOverVotes = 2;         // one keyframe that sees over it counts as much as two that do not
constexpr double kSquareCos = 0.3;    // a grazing ray tells little
constexpr double kMaxSeenOver = 0.5;  // share of a wall's columns: windows

// What was seen of one column of a wall within the band: the first and last cell along the wall; nothing if first > last.
struct Column {
  double first_m = 1e9, last_m = -1e9;

  [[nodiscard]] bool seen() const { return first_m <= last_m; }
};

// By distance from the surface's start.
std::vector<Column> ColumnsIn(const MapSurface& s, const HeightBand& band) {
  std::vector<Column> columns(static_cast<size_t>(std::ceil(s.length_m() / kColumn_m)) + 1);
  for (const Eigen::Vector2f& cell : s.cells) {
    if (static_cast<double>(cell.y()) < band.low_m || static_cast<double>(cell.y()) > band.high_m) continue;
    const double at_m = static_cast<double>(cell.x());
    const auto i = static_cast<size_t>(std::max(0.0, std::floor(at_m / kColumn_m)));
    Column& column = columns[std::min(i, columns.size() - 1)];
    column.first_m = std::min(column.first_m, at_m);
    column.last_m = std::max(column.last_m, at_m);
  }
  return columns;
}

// By a third of the keyframes that look at it squarely and past whatever is in front: from close by, few rays are steep enough.
bool SeenOver(const Eigen::Vector2d& at, const MapSurface& s, const std::vector<RangeProfile>& profiles) {
  int over = 0, not_over = 0;
  for (const Observation& o : s.observations) {
    const RangeProfile& profile = profiles[o.keyframe];
    if (profile.rays.empty()) continue;
    const Eigen::Vector2d step = at - profile.at;
    const double distance_m = step.norm(), reach_m = static_cast<double>(profile.Towards(step).step.norm());
    if (-s.plane.n.head<2>().dot(step) < kSquareCos * distance_m || reach_m < distance_m - kBeyond_m) continue;
    ++(reach_m > distance_m + kBeyond_m ? over : not_over);
  }
  return kOverVotes * over > not_over;
}

bool IsFurniture(const MapSurface& s, const std::vector<Column>& columns, const HeightBand& band,
                 const std::vector<RangeProfile>& profiles) {
  if (s.z_max_m >= band.low_m + kTall_m) return false;
  const Eigen::Vector2d along = (s.end - s.start).normalized();
  size_t count = 0, seen_over = 0;
  for (size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].seen()) continue;
    ++count;
    seen_over += SeenOver(s.start + 0.5 * (columns[i].first_m + columns[i].last_m) * along, s, profiles) ? 1 : 0;
  }
  return static_cast<double>(seen_over) > kMaxSeenOver * static_cast<double>(count);
}

void AddPieces(const MapSurface& s, const std::vector<Column>& columns, std::vector<WallPiece>* pieces) {
  const Eigen::Vector2d along = (s.end - s.start).normalized();
  const auto add = [&](double first_m, double last_m) {
    const double from_m = std::max(0.0, first_m), to_m = std::min(last_m, s.length_m());
    if (to_m - from_m >= kMinPiece_m) pieces->push_back({s.id, s.start + from_m * along, s.start + to_m * along});
  };
  Column piece;
  for (const Column& column : columns) {
    if (!column.seen()) continue;
    if (piece.seen() && column.first_m - piece.last_m > kMaxGap_m) {
      add(piece.first_m, piece.last_m);
      piece = {};
    }
    piece.first_m = std::min(piece.first_m, column.first_m);
    piece.last_m = column.last_m;
  }
  if (piece.seen()) add(piece.first_m, piece.last_m);
}

}  // namespace

std::vector<WallPiece> FindWallPieces(const SGraph& graph, const HeightBand& band, const std::vector<RangeProfile>& profiles) {
  std::vector<WallPiece> pieces;
  for (const MapSurface& s : graph.surfaces) {
    if (s.kind != SurfaceKind::kWall || s.observations.empty() || s.z_max_m < band.low_m || s.z_min_m > band.high_m) continue;
    if (s.length_m() < kMinPiece_m) continue;
    const std::vector<Column> columns = ColumnsIn(s, band);
    if (!IsFurniture(s, columns, band, profiles)) AddPieces(s, columns, &pieces);
  }
  return pieces;
}

}  // namespace plumb::runtime
