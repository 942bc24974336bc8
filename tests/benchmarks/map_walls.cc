#include "tests/benchmarks/map_walls.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>

#include "tools/simulate/as_built.h"
#include "tools/simulate/clutter.h"
#include "tools/simulate/wall_changes.h"

namespace plumb::benchmarks {

using runtime::MapSurface;
using runtime::Scan;
using runtime::SGraph;
using runtime::SurfaceKind;

namespace {

constexpr double kMinLength_m = 1.0, kSameDirection_rad = 0.2, kSamePlane_m = 0.15, kMinShare = 0.5;
constexpr double kTwice_m = 0.1, kTwiceShare = 0.3;
constexpr double kReal_m = 0.015;                          // from a surface of the map to the face of the house that it is
constexpr double kPhantom_m = 0.025, kPhantomShare = 0.5;  // further from any face, this share of a surface
constexpr double kOneFace_m = 0.01;                        // two surfaces of the map whose faces are closer are one
constexpr uint32_t kMinScans = 20;
constexpr double kSquare_m = 0.25;  // of a built face, seen by a scan that has kMinSquarePoints returns from it
constexpr double kOnFace_m = 0.06, kSeenOff_m = 0.015, kBuilt_m = 0.005;
constexpr double kEdge_m = 0.1;  // of a face, next to floor and ceiling, whose returns could pass for its own
constexpr int kMinSquarePoints = 3;
constexpr double kNamedOff_m = 0.01, kNamedTurn_deg = 0.2, kNamedPlane_m = 0.4;
constexpr double kDegrees = 57.29578;

double Turn_rad(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  return std::atan2(u.x() * v.y() - u.y() * v.x(), u.head<2>().dot(v.head<2>()));
}

double TiltOf_deg(const MappedFace& m) { return std::asin(m.plane.n.z()) * kDegrees; }

// How far the map's surface stands before the built face at a point of that.
double OffsetAt_m(const BuiltFace& b, const MappedFace& m, const Eigen::Vector3d& p) {
  return -m.plane.SignedDistance(p) / m.plane.n.dot(b.normal());
}

Eigen::Vector3d CenterOf(const BuiltFace& b, size_t square) {
  const Eigen::Vector2d at = b.start + kSquare_m * (static_cast<double>(square % b.columns) + 0.5) * b.direction();
  return {at.x(), at.y(), b.z_min_m + kEdge_m + kSquare_m * (static_cast<double>(square / b.columns) + 0.5)};
}

// The squares of a built face that a surface of the map has.
std::set<size_t> Covered(const BuiltFace& b, const MappedFace& m, double within_m) {
  std::set<size_t> covered;
  if (std::abs(Turn_rad(b.normal(), m.plane.n)) > kSameDirection_rad) return covered;
  const Eigen::Vector3d start(b.start.x(), b.start.y(), 0);
  for (const Eigen::Vector3d& p : m.cells) {
    if (std::abs(b.normal().dot(p - start)) > within_m) continue;
    if (const auto square = b.SquareAt(p)) covered.insert(*square);
  }
  return covered;
}

void Name(const char* what, const BuiltFace& b, const std::vector<MappedFace>& mapped) {
  fmt::print(stderr, "  {}: ({:.2f} {:.2f}) to ({:.2f} {:.2f}) from {:.2f} m to {:.2f} m high, of which {:.2f} m were seen\n", what,
             b.start.x(), b.start.y(), b.end.x(), b.end.y(), b.z_min_m, b.z_max_m, b.seen_m());
  for (const MappedFace& m : mapped) {
    const std::set<size_t> covered = Covered(b, m, kNamedPlane_m);
    if (covered.empty()) continue;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    size_t first = b.columns, last = 0;
    for (const size_t square : covered) {
      middle += CenterOf(b, square) / static_cast<double>(covered.size());
      first = std::min(first, square % b.columns);
      last = std::max(last, square % b.columns + 1);
    }
    const auto seen = std::count_if(covered.begin(), covered.end(), [&](size_t square) { return b.Seen(square); });
    fmt::print(stderr,
               "    map: {:.2f} m to {:.2f} m along, {:.1f} mm in front, {:.2f} deg, tilt {:.2f}, {:.2f} m to {:.2f} m high, {} of {} "
               "squares, {} views, {} points\n",
               kSquare_m * static_cast<double>(first), kSquare_m * static_cast<double>(last), 1000 * OffsetAt_m(b, m, middle),
               Turn_rad(b.normal(), m.plane.n) * kDegrees, TiltOf_deg(m), m.z_min_m, m.z_max_m, seen, covered.size(), m.views,
               static_cast<int64_t>(m.points));
  }
}

// Share of a's cells where b has some, too, and the house has nothing at a, or one face for both.
double DoubledShare(const MappedFace& a, const MappedFace& b, const BuiltHouse& house) {
  const Eigen::Vector3d along = Eigen::Vector3d::UnitZ().cross(-b.plane.n).normalized();
  const auto cell = [&](const Eigen::Vector3d& p) {
    return std::array<int, 2>{static_cast<int>(std::floor(10 * along.dot(p))), static_cast<int>(std::floor(10 * p.z()))};
  };
  std::set<std::array<int, 2>> known;
  for (const Eigen::Vector3d& p : b.cells) known.insert(cell(p));
  size_t doubled = 0;
  for (const Eigen::Vector3d& p : a.cells) {
    if (!known.contains(cell(p))) continue;
    const Eigen::Vector3d other = p - b.plane.SignedDistance(p) * b.plane.n;
    if (std::abs(b.plane.SignedDistance(p)) > kTwice_m) continue;
    const auto at_a = house.FaceNear_m(p, a.plane.n, kReal_m), at_b = house.FaceNear_m(other, a.plane.n, kReal_m);
    const double step_m = at_a && at_b ? std::abs(a.plane.n.dot(p - other) + *at_a - *at_b) : 0;
    doubled += !at_a || (at_b && step_m < kOneFace_m);
  }
  return a.cells.empty() ? 0 : static_cast<double>(doubled) / static_cast<double>(a.cells.size());
}

bool IsTwice(const MappedFace& a, const MappedFace& b, const BuiltHouse& house) {
  if (std::abs(Turn_rad(a.plane.n, b.plane.n)) > kSameDirection_rad) return false;
  return DoubledShare(a, b, house) >= kTwiceShare || DoubledShare(b, a, house) >= kTwiceShare;
}

// Share of its cells where the house has no such face.
double PhantomShare(const MappedFace& m, const BuiltHouse& house) {
  const auto nowhere =
      std::count_if(m.cells.begin(), m.cells.end(), [&](const Eigen::Vector3d& p) { return !house.FaceNear_m(p, m.plane.n, kPhantom_m); });
  return m.cells.empty() ? 0 : static_cast<double>(nowhere) / static_cast<double>(m.cells.size());
}

void NameMapped(const char* what, const MappedFace& f) {
  fmt::print(stderr, "  {}: ({:.2f} {:.2f}) to ({:.2f} {:.2f}) from {:.2f} m to {:.2f} m high, {} views, {} points\n", what, f.start.x(),
             f.start.y(), f.end.x(), f.end.y(), f.z_min_m, f.z_max_m, f.views, static_cast<int64_t>(f.points));
}

// The wall's score, and its line on stderr.
void ScoreWall(const BuiltFace& b, const std::vector<MappedFace>& mapped, bool name, WallScore& out) {
  ++out.walls;
  std::set<size_t> columns, best_squares;
  const MappedFace* best = nullptr;
  for (const MappedFace& m : mapped) {
    std::set<size_t> covered = Covered(b, m, kSamePlane_m);
    std::erase_if(covered, [&](size_t square) { return !b.Seen(square); });
    for (const size_t square : covered) columns.insert(square % b.columns);
    if (covered.size() <= best_squares.size()) continue;
    best_squares = std::move(covered);
    best = &m;
  }
  if (best == nullptr || kSquare_m * static_cast<double>(columns.size()) < kMinShare * b.seen_m()) {
    if (name) Name("missed", b, mapped);
    return;
  }
  ++out.found;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const size_t square : best_squares) middle += CenterOf(b, square) / static_cast<double>(best_squares.size());
  out.offsets_m.push_back(std::abs(OffsetAt_m(b, *best, middle)));
  out.turns_deg.push_back(std::abs(Turn_rad(b.normal(), best->plane.n)) * kDegrees);
  out.tilts_deg.push_back(std::abs(TiltOf_deg(*best)));
  if (name && (out.offsets_m.back() > kNamedOff_m || std::max(out.turns_deg.back(), out.tilts_deg.back()) > kNamedTurn_deg))
    Name("off", b, mapped);
}

}  // namespace

std::optional<BuiltHouse> BuiltHouse::Build(const AGraph& plan, const tools::SimulateOptions& options, StoreyId storey) {
  auto built = tools::BuildWithDeviations(plan, storey, options);
  if (!built || !tools::LeaveOutWalls(plan, storey, options.missing, options.seed, *built) ||
      !tools::AddWalls(plan, storey, options.unplanned, options.seed, *built))
    return std::nullopt;
  if (options.clutter > 0) (void)tools::AddClutter(*built, storey, options.clutter, options.seed);
  return BuiltHouse(built->house, plan.origin);
}

std::optional<double> BuiltHouse::FaceNear_m(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double reach_m) const {
  constexpr double kPast_m = 1e-4;
  std::optional<double> best;
  for (double from_m = reach_m; from_m > -reach_m;) {
    const runtime::RayHit hit =
        caster_.Cast({(p + from_m * n - origin_).cast<float>(), (-n).cast<float>(), static_cast<float>(from_m + reach_m)});
    if (!hit.hit()) break;
    from_m -= static_cast<double>(hit.range_m);
    const bool across = static_cast<double>(hit.normal.dot(n.cast<float>())) > std::cos(kSameDirection_rad);
    if (across && (!best || std::abs(from_m) < std::abs(*best))) best = from_m;
    from_m -= kPast_m;
  }
  return best;
}

std::optional<size_t> BuiltFace::SquareAt(const Eigen::Vector3d& p) const {
  const double column = direction().dot(p.head<2>() - start) / kSquare_m, row = (p.z() - z_min_m - kEdge_m) / kSquare_m;
  if (column < 0 || row < 0 || column >= static_cast<double>(columns) || row >= static_cast<double>(rows)) return std::nullopt;
  return static_cast<size_t>(row) * columns + static_cast<size_t>(column);
}

bool BuiltFace::Seen(size_t square) const {
  const Square& s = squares[square];
  return s.built && s.scans >= kMinScans && std::abs(s.sum_m) <= kSeenOff_m * s.returns;
}

double BuiltFace::seen_m() const {
  std::set<size_t> seen;
  for (size_t i = 0; i < squares.size(); ++i) {
    if (Seen(i)) seen.insert(i % columns);
  }
  return kSquare_m * static_cast<double>(seen.size());
}

std::vector<BuiltFace> BuiltFaces(const AGraph& plan, const tools::SimulateSummary& simulated, const BuiltHouse& house) {
  std::vector<BuiltFace> out;
  for (size_t i = 0; i < plan.surfaces.size(); ++i) {
    const Surface& s = plan.surfaces[i];
    if (s.arc || s.storey != simulated.storey || simulated.surface_scans[i] < kMinScans || (s.end - s.start).norm() < kMinLength_m ||
        std::abs(s.normal.z()) > 0.1)
      continue;
    Eigen::Isometry2d T = Eigen::Isometry2d::Identity();  // the built face, given the planned one
    const Eigen::Vector2d mid = 0.5 * (s.start + s.end), normal = s.normal.head<2>().normalized();
    for (const tools::WallDisplacement& wall : simulated.walls) {
      for (const tools::SurfaceDisplacement& d : wall.surfaces) {
        if (d.surface == SurfaceId(i))
          T = Eigen::Translation2d(mid + d.translation_m * normal) * Eigen::Rotation2Dd(d.rotation_rad) * Eigen::Translation2d(-mid);
      }
    }
    BuiltFace b{T * s.start, T * s.end, s.z_min_m, s.z_max_m, 0, 0, {}};
    b.columns = static_cast<size_t>(b.length_m() / kSquare_m);
    b.rows = static_cast<size_t>(std::max(0.0, b.z_max_m - b.z_min_m - 2 * kEdge_m) / kSquare_m);
    b.squares.resize(b.columns * b.rows);
    for (size_t k = 0; k < b.squares.size(); ++k) b.squares[k].built = house.FaceNear_m(CenterOf(b, k), b.normal(), kBuilt_m).has_value();
    out.push_back(std::move(b));
  }
  return out;
}

void CountSeen(const Scan& deskewed, const Eigen::Isometry3d& T_plan_lidar, std::vector<BuiltFace>& built) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : deskewed.points) points.emplace_back(T_plan_lidar * p.cast<double>());
  std::vector<int> returns;
  for (BuiltFace& face : built) {
    const Eigen::Vector3d start(face.start.x(), face.start.y(), 0), normal = face.normal();
    if (normal.dot(T_plan_lidar.translation() - start) <= 0) continue;
    returns.assign(face.squares.size(), 0);
    for (const Eigen::Vector3d& p : points) {
      const double before_m = normal.dot(p - start);
      const auto square = std::abs(before_m) <= kOnFace_m ? face.SquareAt(p) : std::nullopt;
      if (!square) continue;
      ++returns[*square];
      face.squares[*square].returns += 1;
      face.squares[*square].sum_m += before_m;
    }
    for (size_t i = 0; i < returns.size(); ++i) face.squares[i].scans += returns[i] >= kMinSquarePoints;
  }
}

std::vector<MappedFace> MappedFaces(const SGraph& map, const Eigen::Isometry3d& T_plan_map) {
  std::vector<MappedFace> out;
  for (const MapSurface& s : map.surfaces) {
    if (s.kind != SurfaceKind::kWall || s.observations.empty()) continue;
    // The ends are known to 5 cm, the plane between them better.
    const auto on_plane = [&](const Eigen::Vector2d& at, double z_m) -> Eigen::Vector3d {
      const Eigen::Vector3d p(at.x(), at.y(), z_m);
      return T_plan_map * (p - s.plane.SignedDistance(p) * s.plane.n);
    };
    const double middle_m = 0.5 * (s.z_min_m + s.z_max_m), z_m = T_plan_map.translation().z();
    MappedFace m{s.plane.Transformed(T_plan_map),
                 on_plane(s.start, middle_m).head<2>(),
                 on_plane(s.end, middle_m).head<2>(),
                 s.z_min_m + z_m,
                 s.z_max_m + z_m,
                 s.num_points,
                 s.observations.size(),
                 {}};
    const Eigen::Vector2d along = (s.end - s.start).normalized();
    for (const Eigen::Vector2f& c : s.cells)
      m.cells.push_back(on_plane(s.start + static_cast<double>(c.x()) * along, static_cast<double>(c.y())));
    out.push_back(std::move(m));
  }
  return out;
}

WallScore ScoreWalls(const std::vector<BuiltFace>& built, const std::vector<MappedFace>& mapped, const BuiltHouse& house, bool name) {
  WallScore out;
  for (const BuiltFace& b : built) {
    if (b.seen_m() >= kMinLength_m) ScoreWall(b, mapped, name, out);
  }
  std::vector<const MappedFace*> walls;  // of the map, without furniture
  for (const MappedFace& m : mapped) {
    if (std::any_of(built.begin(), built.end(), [&](const BuiltFace& b) { return !Covered(b, m, kSamePlane_m).empty(); }))
      walls.push_back(&m);
  }
  for (size_t i = 0; i < walls.size(); ++i) {
    for (size_t j = i + 1; j < walls.size(); ++j) {
      if (!IsTwice(*walls[i], *walls[j], house)) continue;
      ++out.twice;
      if (!name) continue;
      for (const MappedFace* f : {walls[i], walls[j]}) NameMapped("twice", *f);
    }
  }
  for (const MappedFace& m : mapped) {
    if (PhantomShare(m, house) < kPhantomShare) continue;
    ++out.phantoms;
    if (name) NameMapped("phantom", m);
  }
  return out;
}

}  // namespace plumb::benchmarks
