#include "runtime/mapping/keyframe_merging.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/mapping/mapper.h"

namespace plumb::runtime {
namespace {

// Views of the plane x = 5 in the map, from keyframes turned and moved as a real robot's.
PlaneStats WallSeenFrom(const Eigen::Isometry3d& T_map_kf, double points) {
  PlaneStats stats;
  for (double i = 0; i < points; ++i) stats.Add(T_map_kf.inverse() * Eigen::Vector3d(5, 0.1 * i, 0.03 * i * i));
  return stats;
}

Keyframe KeyframeAt(uint32_t id, double x_m, double yaw_rad) {
  Keyframe keyframe;
  keyframe.id = id;
  keyframe.T_map_kf = keyframe.T_odom_kf = Eigen::Translation3d(x_m, 0, 0) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  keyframe.points.assign(1000, Eigen::Vector3f::Ones());
  return keyframe;
}

// Two surfaces; the first is seen from all keyframes, the second from the last only, by `other_points` points to a hundred on the first.
SGraph Graph(const std::vector<double>& xs_m, double other_points) {
  SGraph graph;
  graph.surfaces.resize(2);
  for (uint32_t i = 0; i < xs_m.size(); ++i) {
    graph.keyframes.push_back(KeyframeAt(i, xs_m[i], 0.3 * i));
    graph.surfaces[0].observations.push_back({i, WallSeenFrom(graph.keyframes[i].T_map_kf, 100)});
  }
  const uint32_t last = static_cast<uint32_t>(xs_m.size() - 1);
  if (other_points > 0) graph.surfaces[1].observations.push_back({last, WallSeenFrom(graph.keyframes[last].T_map_kf, other_points)});
  return graph;
}

MapperOptions WellKnownAfter(int views) {
  MapperOptions options;
  options.well_known_views = views;
  return options;
}

TEST(RedundantTo, IsANearKeyframeThatSawTheSameWellKnownSurfaces) {
  const SGraph graph = Graph({0, 1, 2, 0.3}, 0);
  EXPECT_EQ(RedundantTo(graph, 3, WellKnownAfter(3)), 0u);
  EXPECT_EQ(RedundantTo(graph, 3, WellKnownAfter(4)), std::nullopt) << "not seen often enough";
  EXPECT_EQ(RedundantTo(graph, 2, WellKnownAfter(1)), std::nullopt) << "too far off";
}

TEST(RedundantTo, IsNoneForAKeyframeThatSawSomethingNew) {
  EXPECT_EQ(RedundantTo(Graph({0, 0.3}, 5), 1, WellKnownAfter(1)), 0u);
  EXPECT_EQ(RedundantTo(Graph({0, 0.3}, 20), 1, WellKnownAfter(1)), std::nullopt);
}

TEST(RedundantTo, IsNeverAMergedKeyframe) {
  SGraph graph = Graph({0, 0.3, 0.2}, 0);
  MergeKeyframe(1, 0, &graph);
  EXPECT_EQ(RedundantTo(graph, 2, WellKnownAfter(1)), 0u);
}

TEST(MergeKeyframe, LosesNothingThatWasMeasured) {
  SGraph graph = Graph({0, 1, 0.3}, 10);
  const auto sum = [&](const MapSurface& surface) {
    PlaneStats all;
    for (const Observation& o : surface.observations) all.Add(o.stats.Transformed(graph.keyframes[o.keyframe].T_map_kf));
    return all;
  };
  const PlaneStats wall = sum(graph.surfaces[0]), other = sum(graph.surfaces[1]);
  MergeKeyframe(2, 0, &graph);
  ASSERT_TRUE(graph.keyframes[2].merged);
  EXPECT_EQ(graph.keyframes[2].points.capacity(), 0u);
  EXPECT_EQ(graph.keyframes[2].standpoints.capacity(), 0u);
  EXPECT_EQ(graph.surfaces[0].observations.size(), 2u);
  EXPECT_EQ(graph.surfaces[1].observations.at(0).keyframe, 0u);
  EXPECT_TRUE(sum(graph.surfaces[0]).C.isApprox(wall.C, 1e-9));
  EXPECT_TRUE(sum(graph.surfaces[1]).C.isApprox(other.C, 1e-9));
}

TEST(Mapper, CarriesMergedKeyframesAlong) {
  Mapper mapper;
  mapper.mutable_graph() = Graph({0, 1, 0.3, 2}, 0);
  SGraph& graph = mapper.mutable_graph();
  graph.surfaces.clear();  // the mapper made none of these
  MergeKeyframe(2, 0, &graph);
  const Eigen::Isometry3d T_0_2 = graph.keyframes[0].T_map_kf.inverse() * graph.keyframes[2].T_map_kf;
  graph.keyframes[0].T_map_kf = Eigen::Translation3d(0.2, -0.1, 0) * graph.keyframes[0].T_map_kf;
  mapper.OnPosesChanged();
  EXPECT_TRUE((graph.keyframes[0].T_map_kf * T_0_2).isApprox(graph.keyframes[2].T_map_kf, 1e-12));
}

TEST(BoundPoints, ThinsThoseWithMostEvenly) {
  std::vector<Keyframe> keyframes(3);
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < (i == 0 ? 1000u : 4000u); ++k) keyframes[i].points.emplace_back(static_cast<float>(k), 0.0f, 0.0f);
  }
  BoundPoints(9000, &keyframes);
  EXPECT_EQ(keyframes[1].points.size(), 4000u);
  BoundPoints(5000, &keyframes);
  EXPECT_EQ(keyframes[0].points.size(), 1000u);
  ASSERT_EQ(keyframes[1].points.size(), 2000u);
  EXPECT_EQ(keyframes[2].points.size(), 2000u);
  EXPECT_EQ(keyframes[1].points[7].x(), 14.0f);
  BoundPoints(1, &keyframes);  // what matching needs stays
  for (const Keyframe& keyframe : keyframes) EXPECT_GE(keyframe.points.size(), 250u);
}

}  // namespace
}  // namespace plumb::runtime
