#include "compiler/frontends/ifc/ifc_flat_rings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace plumb::compiler {
namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

AlignedBox2d BoxOf(const Ring2& ring) {
  AlignedBox2d box;
  for (const Vector2d& p : ring) box.extend(p);
  return box;
}

void Move(const Vector2d& by, FlatRing& ring) {
  for (Vector2d& p : ring.flat) p += by;
}

void Reverse(FlatRing& ring) {
  std::reverse(ring.flat.begin(), ring.flat.end());
  std::reverse(ring.points.begin(), ring.points.end());
  ring.turn = -ring.turn;
}

// The axis along which the ring goes once round. None: it does not, or along both.
std::optional<int> AxisOnceRound(const Vector2d& periods, const FlatRing& ring) {
  for (int k = 0; k < 2; ++k) {
    if (ring.turn[k] != 0 && ring.turn[1 - k] == 0 && std::abs(ring.turn[k]) < 1.5 * periods[k]) return k;
  }
  return std::nullopt;
}

// Whether some whole period brings one of the boxes between the two places along the axis.
bool IsTaken(const std::vector<AlignedBox2d>& boxes, int axis, double period_m, double low_m, double high_m) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const AlignedBox2d& box) {
    return box.min()[axis] + period_m * std::ceil((low_m - box.max()[axis]) / period_m) <= high_m;
  });
}

// Points of both rings that are closest among those with no hole between; the second one moved by `shift`.
struct Seam {
  size_t a = 0, b = 0;
  Vector2d shift = Vector2d::Zero();
};

std::optional<Seam> FindSeam(const Vector2d& periods, int axis, const FlatRing& a, const FlatRing& b,
                             const std::vector<AlignedBox2d>& holes) {
  std::optional<Seam> best;
  double least_m2 = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < a.flat.size(); ++i) {
    const Vector2d& p = a.flat[i];
    if (IsTaken(holes, axis, periods[axis], p[axis], p[axis])) continue;
    for (size_t j = 0; j < b.flat.size(); ++j) {
      const Vector2d shift = WholePeriods(periods, b.flat[j], p), q = b.flat[j] + shift;
      const double apart_m2 = (q - p).squaredNorm();
      if (apart_m2 >= least_m2 || IsTaken(holes, axis, periods[axis], std::min(p[axis], q[axis]), std::max(p[axis], q[axis]))) continue;
      least_m2 = apart_m2;
      best = Seam{i, j, shift};
    }
  }
  return best;
}

// Appends the ring from its point `start` on all round to that point again.
void AppendRound(const FlatRing& ring, size_t start, const Vector2d& shift, FlatRing& out) {
  const size_t n = ring.flat.size();
  for (size_t k = start; k <= start + n; ++k) {
    out.flat.push_back(ring.flat[k % n] + shift + (k >= n ? ring.turn : Vector2d(Vector2d::Zero())));
    out.points.push_back(ring.points[k % n]);
  }
}

// Makes the first ring of those that go round the surface.
bool JoinRound(const IfcModel& model, const Vector2d& periods, std::vector<FlatRing>& rings) {
  const auto holes = std::stable_partition(rings.begin(), rings.end(), [](const FlatRing& ring) { return !ring.turn.isZero(); });
  if (holes - rings.begin() != 2) return false;
  const FlatRing& a = rings[0];
  FlatRing& b = rings[1];
  const std::optional<int> axis = AxisOnceRound(periods, a);
  constexpr size_t kStepsPerPair = 4;
  if (!axis || AxisOnceRound(periods, b) != axis || !model.SpendOnSurface(kStepsPerPair * a.flat.size() * b.flat.size())) return false;
  if (a.turn[*axis] * b.turn[*axis] > 0) Reverse(b);
  std::vector<AlignedBox2d> boxes;
  for (auto ring = holes; ring != rings.end(); ++ring) boxes.push_back(BoxOf(ring->flat));
  const std::optional<Seam> seam = FindSeam(periods, *axis, a, b, boxes);
  if (!seam) return false;
  FlatRing joined;
  AppendRound(a, seam->a, Vector2d::Zero(), joined);
  AppendRound(b, seam->b, seam->shift + a.turn, joined);
  const double start_m = std::min(joined.flat.front()[*axis], joined.flat[a.flat.size()][*axis]);
  rings.erase(rings.begin());
  rings.front() = std::move(joined);
  for (size_t r = 1; r < rings.size(); ++r) {  // its middle between the seam and the seam a period on
    Vector2d by = Vector2d::Zero();
    by[*axis] = -periods[*axis] * std::floor((boxes[r - 1].center()[*axis] - start_m) / periods[*axis]);
    Move(by, rings[r]);
  }
  return true;
}

}  // namespace

Vector2d WholePeriods(const Vector2d& periods, const Vector2d& from, const Vector2d& to) {
  Vector2d out = Vector2d::Zero();
  for (int k = 0; k < 2; ++k) {
    if (periods[k] > 0) out[k] = periods[k] * std::round((to[k] - from[k]) / periods[k]);
  }
  return out;
}

bool PlaceRings(const IfcModel& model, const Vector2d& periods, std::vector<FlatRing>& rings) {
  const auto goes_round = [](const FlatRing& ring) { return !ring.turn.isZero(); };
  const auto count = std::count_if(rings.begin(), rings.end(), goes_round);
  const bool from_pole = count == 1 && goes_round(rings[0]) && rings[0].has_pole;
  if (count > 0 && !from_pole) return JoinRound(model, periods, rings);
  for (size_t r = 1; r < rings.size(); ++r)
    Move(WholePeriods(periods, BoxOf(rings[r].flat).center(), BoxOf(rings[0].flat).center()), rings[r]);
  return true;
}

}  // namespace plumb::compiler
