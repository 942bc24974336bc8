#include "compiler/frontends/mesh/mesh_levels.h"

#include <algorithm>
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
  const double plan_m2 = profile.box.sizes().x() * profile.box.sizes().y(), top_m = profile.Z(top) + 0.5 * kBin_m;
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
