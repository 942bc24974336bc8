#include "runtime/mapping/keyframe_merging.h"

#include <algorithm>

namespace plumb::runtime {
namespace {

constexpr size_t kLeastPoints = 500;  // a keyframe with fewer is not thinned: it could not be matched by them

struct SeenPoints {
  const MapSurface* surface = nullptr;
  double num_points = 0;
};

}  // namespace

std::optional<uint32_t> RedundantTo(const SGraph& graph, uint32_t keyframe, const MapperOptions& options) {
  std::vector<SeenPoints> well_known;
  double num_points = 0;
  for (const MapSurface& surface : graph.surfaces) {
    const Observation* const seen = FindObservation(surface, keyframe);
    if (seen == nullptr) continue;
    num_points += seen->stats.count();
    if (surface.observations.size() > static_cast<size_t>(options.well_known_views)) well_known.push_back({&surface, seen->stats.count()});
  }
  std::optional<uint32_t> best;
  double most = options.redundant_share * num_points;
  const Eigen::Vector3d at = graph.keyframes[keyframe].T_map_kf.translation();
  for (uint32_t other = 0; other < keyframe; ++other) {
    const Keyframe& into = graph.keyframes[other];
    if (into.merged || (into.T_map_kf.translation() - at).norm() >= options.redundant_distance_m) continue;
    double shared = 0;
    for (const SeenPoints& seen : well_known) shared += FindObservation(*seen.surface, other) != nullptr ? seen.num_points : 0;
    if (shared <= most) continue;
    most = shared;
    best = other;
  }
  return best;
}

void MergeKeyframe(uint32_t keyframe, uint32_t into, SGraph* graph) {
  Keyframe& merged = graph->keyframes[keyframe];
  merged.merged = Keyframe::Merged{into, graph->keyframes[into].T_map_kf.inverse() * merged.T_map_kf};
  graph->keyframes[into].smear.Cover(merged.smear.Rotated(merged.merged->T_into_kf.linear()));
  merged.points = std::vector<Eigen::Vector3f>();  // an empty list in its place would keep the memory
  merged.standpoints = std::vector<Keyframe::Standpoint>();
  for (MapSurface& surface : graph->surfaces) {
    std::vector<Observation>& observations = surface.observations;
    const Observation* const seen = FindObservation(surface, keyframe);
    if (seen == nullptr) continue;
    const Observation moved{into, seen->stats.Transformed(merged.merged->T_into_kf)};
    observations.erase(observations.begin() + (seen - observations.data()));
    const auto at =
        std::lower_bound(observations.begin(), observations.end(), into, [](const Observation& o, uint32_t k) { return o.keyframe < k; });
    if (at != observations.end() && at->keyframe == into) {
      at->stats.Add(moved.stats);
    } else {
      observations.insert(at, moved);
    }
  }
}

void BoundPoints(size_t max_points, std::vector<Keyframe>* keyframes) {
  for (;;) {
    size_t total = 0, most = 0;
    for (const Keyframe& keyframe : *keyframes) {
      total += keyframe.points.size();
      most = std::max(most, keyframe.points.size());
    }
    if (total <= max_points || most <= kLeastPoints) return;
    for (Keyframe& keyframe : *keyframes) {
      std::vector<Eigen::Vector3f>& points = keyframe.points;
      if (2 * points.size() <= most) continue;
      const size_t count = (points.size() + 1) / 2;
      for (size_t i = 0; i < count; ++i) points[i] = points[2 * i];
      points.resize(count);
      points.shrink_to_fit();
      for (Keyframe::Standpoint& standpoint : keyframe.standpoints) standpoint.first_point = (standpoint.first_point + 1) / 2;
    }
  }
}

}  // namespace plumb::runtime
