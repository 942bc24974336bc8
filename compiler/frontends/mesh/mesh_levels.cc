#include "compiler/frontends/mesh/mesh_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace plumb::compiler {
namespace {

using Eigen::Vector3d;

constexpr double kUpright = 0.1, kLevel = 0.98;  // of the normal's z
constexpr double kBin_m = 0.02;
constexpr double kFloorShare = 0.15;  // of the plan's extent that a floor covers at least
constexpr double kSlab_m = 0.6;       // the faces of one floor lie within it
constexpr double kMinStorey_m = 1.9;
constexpr double kEyes_m = 1.1;    // where walls are looked for above a floor
constexpr double kStanding = 0.3;  // of the length of walls where it is greatest, to count as a storey
// Where walls end and others begin.
constexpr double kWithinSlab_m = 0.05, kAboveFloor_m = 0.3, kBelowFloor_m = 0.15;
constexpr double kSlabShare = 0.6;  // of the length of walls above and below that goes on through a slab
constexpr double kSeamShare = 0.5, kSeamChange = 0.02;
constexpr double kWeld_m = 0.005;
constexpr size_t kMaxBreaks = 40;
constexpr double kMinSlice_m = 0.02;

struct Corners {
  Vector3d a, b, c, n;  // n: normal times twice the area
};

template <class Visit>
void ForEach(const std::vector<MeshObject>& objects, const Visit& visit) {
  for (const MeshObject& o : objects) {
    for (const Eigen::Vector3i& t : o.solid.triangles) {
      Corners f{o.solid.vertices[static_cast<size_t>(t[0])],
                o.solid.vertices[static_cast<size_t>(t[1])],
                o.solid.vertices[static_cast<size_t>(t[2])],
                {}};
      f.n = (f.b - f.a).cross(f.c - f.a);
      if (f.n.squaredNorm() > 0) visit(f);
    }
  }
}

// Upright area per height, and horizontal area, in bins of a common grid.
struct Profile {
  double z0_m = 0;
  std::vector<double> upright, level;
  Eigen::AlignedBox3d box;
  [[nodiscard]] double UprightAt(double z_m) const {
    const double i = (z_m - z0_m) / kBin_m;
    return i < 0 || i >= static_cast<double>(upright.size()) ? 0 : upright[static_cast<size_t>(i)];
  }
  [[nodiscard]] double Z(size_t i) const { return z0_m + (static_cast<double>(i) + 0.5) * kBin_m; }
};

Profile ProfileOf(const std::vector<MeshObject>& walls, const std::vector<MeshObject>& objects) {
  Profile out;
  for (const MeshObject& o : walls) out.box.extend(Bounds(o.solid));
  if (out.box.isEmpty()) return out;
  constexpr double kMaxBins = 100000;
  out.z0_m = out.box.min().z() - kBin_m;
  const auto bins = static_cast<size_t>(std::min(out.box.sizes().z() / kBin_m + 3, kMaxBins));
  out.upright.assign(bins, 0);
  out.level.assign(bins, 0);
  const double bottom = out.box.min().z() - kSlab_m, top = out.box.max().z() + kSlab_m;
  const auto bin = [&](double z) { return std::min(bins - 1, static_cast<size_t>(std::max(0.0, (z - out.z0_m) / kBin_m))); };
  ForEach(objects, [&](const Corners& f) {
    const double z = (f.a.z() + f.b.z() + f.c.z()) / 3;
    if (std::abs(f.n.z()) > kLevel * f.n.norm() && z > bottom && z < top) out.level[bin(z)] += 0.5 * f.n.norm();
  });
  ForEach(walls, [&](const Corners& f) {
    if (std::abs(f.n.z()) > kUpright * f.n.norm()) return;
    const double area = 0.5 * f.n.norm();
    const double low = std::min({f.a.z(), f.b.z(), f.c.z()}), high = std::max({f.a.z(), f.b.z(), f.c.z()});
    const size_t first = bin(low), last = bin(high);
    for (size_t i = first; i <= last; ++i) out.upright[i] += area / static_cast<double>(last - first + 1);
  });
  return out;
}

// Length of the walls' faces in the section at z.
double LengthAt(const std::vector<MeshObject>& walls, double z_m) {
  double out = 0;
  for (const FaceSegment& f : CutScene(walls, z_m)) out += (f.b - f.a).norm();
  return out;
}

// Level edges of upright faces by height: those that faces stand on, and those that faces end with.
struct Edges {
  std::map<int64_t, double> bottoms_m, tops_m;  // by number of kBin_m
  static double Sum(const std::map<int64_t, double>& lengths, int64_t bin) {
    double out = 0;
    for (auto it = lengths.lower_bound(bin - 1); it != lengths.end() && it->first <= bin + 1; ++it) out += it->second;
    return out;
  }
};

Edges EdgesOf(const std::vector<MeshObject>& walls) {
  Edges out;
  ForEach(walls, [&](const Corners& f) {
    if (std::abs(f.n.z()) > kUpright * f.n.norm()) return;
    const std::array<const Vector3d*, 3> corners = {&f.a, &f.b, &f.c};
    for (size_t k = 0; k < 3; ++k) {
      const Vector3d &p = *corners[k], &q = *corners[(k + 1) % 3], &other = *corners[(k + 2) % 3];
      if (std::abs(p.z() - q.z()) > kWeld_m) continue;
      const double z_m = 0.5 * (p.z() + q.z());
      (other.z() > z_m ? out.bottoms_m : out.tops_m)[std::llround(z_m / kBin_m)] += (p - q).norm();
    }
  });
  return out;
}

// Walls that end below z and begin anew at it, on a slab that is not drawn.
bool IsSlab(const std::vector<MeshObject>& walls, double z_m) {
  double below_m = 0;
  for (const double down_m : {0.5, 0.9, 1.2}) below_m = std::max(below_m, LengthAt(walls, z_m - down_m));
  return LengthAt(walls, z_m - kWithinSlab_m) <= kSlabShare * std::min(below_m, LengthAt(walls, z_m + kAboveFloor_m));
}

// Walls that stand on others, with doors from there on: not the panels of one high wall, nor steps of a fine mesh or lintels.
bool IsSeam(const std::vector<MeshObject>& walls, const Edges& edges, int64_t bin, double z_m) {
  const double above_m = LengthAt(walls, z_m + kAboveFloor_m), below_m = LengthAt(walls, z_m - kBelowFloor_m);
  return Edges::Sum(edges.tops_m, bin) >= kSeamShare * below_m && Edges::Sum(edges.bottoms_m, bin) >= kSeamShare * above_m &&
         above_m <= (1 - kSeamChange) * below_m;
}

// Floors of open shells, between two floors that are known: where the walls begin anew.
std::vector<double> FloorsFromWalls(const std::vector<MeshObject>& walls, const Edges& edges, double base_m, double top_m) {
  std::vector<double> out;
  if (top_m - base_m < 2 * kMinStorey_m) return out;
  const double standing_m = kStanding * LengthAt(walls, base_m + kEyes_m);
  std::vector<double> seams;
  for (const auto& [bin, length_m] : edges.bottoms_m) {
    const double z_m = static_cast<double>(bin) * kBin_m;
    if (length_m < standing_m || z_m < base_m + kMinStorey_m || z_m > top_m - kMinStorey_m) continue;
    if (!out.empty() && z_m < out.back() + kMinStorey_m) continue;
    if (IsSlab(walls, z_m))
      out.push_back(z_m);
    else if (IsSeam(walls, edges, bin, z_m))
      seams.push_back(z_m);
  }
  const bool fine_mesh = static_cast<double>(seams.size()) > (top_m - base_m) / kMinStorey_m;
  if (out.empty() && !fine_mesh) {
    for (const double z_m : seams) {
      if (out.empty() || z_m >= out.back() + kMinStorey_m) out.push_back(z_m);
    }
  }
  return out;
}

void AddFloorsFromWalls(const std::vector<MeshObject>& walls, double top_m, std::vector<double>& floors) {
  const Edges edges = EdgesOf(walls);
  std::vector<double> all;
  for (size_t i = 0; i < floors.size(); ++i) {
    all.push_back(floors[i]);
    for (const double z_m : FloorsFromWalls(walls, edges, floors[i], i + 1 < floors.size() ? floors[i + 1] : top_m)) all.push_back(z_m);
  }
  floors = std::move(all);
}

}  // namespace

std::vector<StoreyRange> FindStoreys(const std::vector<MeshObject>& walls, const std::vector<MeshObject>& objects) {
  const Profile profile = ProfileOf(walls, objects);
  if (profile.upright.empty()) return {};
  const double most = *std::max_element(profile.upright.begin(), profile.upright.end());
  if (!(most > 0)) return {};
  const size_t n = profile.upright.size();
  size_t base = 0, top = n - 1;
  while (base < n && profile.upright[base] < kStanding * most) ++base;
  while (top > base && profile.upright[top] < kStanding * most) --top;
  const double plan_m2 = profile.box.sizes().x() * profile.box.sizes().y();
  const double top_bin_m = profile.Z(top) + 0.5 * kBin_m, highest_m = profile.box.max().z();
  const double top_m = std::abs(highest_m - top_bin_m) < 2 * kBin_m ? highest_m : top_bin_m;
  // The upper face of each floor that walls stand on.
  std::vector<double> floors;
  for (size_t i = 0; i + 1 < n; ++i) {
    const double area_m2 = profile.level[i] + profile.level[i + 1];
    if (area_m2 < kFloorShare * plan_m2 || profile.level[i] < profile.level[i + 1]) continue;
    const double z_m = profile.Z(i);
    if (profile.UprightAt(z_m + kEyes_m) < kStanding * most) continue;
    if (!floors.empty() && z_m - floors.back() < kSlab_m)
      floors.back() = z_m;
    else if (floors.empty() || z_m - floors.back() >= kMinStorey_m)
      floors.push_back(z_m);
  }
  const double base_m = profile.Z(base) - 0.5 * kBin_m;
  if (floors.empty() || floors.front() > base_m + kMinStorey_m) floors.insert(floors.begin(), base_m);
  AddFloorsFromWalls(walls, top_m, floors);
  // To the face itself instead of the bin's middle.
  std::map<size_t, std::pair<double, double>> exact;
  ForEach(objects, [&](const Corners& f) {
    for (const Vector3d* p : {&f.a, &f.b, &f.c}) {
      for (size_t i = 0; i < floors.size(); ++i) {
        if (std::abs(p->z() - floors[i]) > 1.5 * kBin_m) continue;
        auto& [sum, weight] = exact[i];
        sum += p->z() * f.n.norm();
        weight += f.n.norm();
      }
    }
  });
  for (const auto& [i, mean] : exact) {
    if (mean.second > 0) floors[i] = mean.first / mean.second;
  }
  std::vector<StoreyRange> out;
  for (size_t i = 0; i < floors.size(); ++i)
    out.push_back({floors[i], i + 1 < floors.size() ? floors[i + 1] : std::max(top_m, floors[i] + kEyes_m)});
  return out;
}

std::vector<double> FindBreaks(const std::vector<MeshObject>& objects, const StoreyRange& range) {
  std::map<int64_t, std::pair<double, double>> found;  // by rounded height: weight, weighted sum
  ForEach(objects, [&](const Corners& f) {
    if (std::abs(f.n.z()) > kUpright * f.n.norm()) return;
    for (const auto& [p, q] : {std::pair(&f.a, &f.b), std::pair(&f.b, &f.c), std::pair(&f.c, &f.a)}) {
      if (std::abs(p->z() - q->z()) > kWeld_m) continue;
      const double z_m = 0.5 * (p->z() + q->z()), length_m = (*p - *q).norm();
      if (z_m <= range.floor_z_m + kMinSlice_m || z_m >= range.top_z_m - kMinSlice_m) continue;
      auto& [weight, sum] = found[std::llround(z_m / kWeld_m)];
      weight += length_m;
      sum += length_m * z_m;
    }
  });
  std::vector<std::pair<double, double>> by_weight;
  for (const auto& [key, value] : found) {
    if (value.first > 0) by_weight.emplace_back(-value.first, value.second / value.first);
  }
  std::sort(by_weight.begin(), by_weight.end());
  std::vector<double> out = {range.floor_z_m, range.top_z_m};
  for (const auto& [minus_weight, z_m] : by_weight) {
    if (out.size() >= kMaxBreaks) break;
    if (std::none_of(out.begin(), out.end(), [z = z_m](double other) { return std::abs(other - z) < kMinSlice_m; })) out.push_back(z_m);
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace plumb::compiler
