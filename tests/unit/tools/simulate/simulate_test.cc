#include "tools/simulate/simulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "runtime/sources/recording.h"
#include "schema/files.h"
#include "tests/support/house.h"
#include "tests/support/temporary_folder.h"
#include "tools/simulate/as_built.h"

namespace plumb::tools {
namespace {

SimulateOptions Short(uint64_t seed) {
  SimulateOptions options;
  options.seed = seed;
  options.deviate = 2;
  options.min_duration_s = options.max_duration_s = 6;
  return options;
}

std::map<std::string, std::vector<uint8_t>> ReadAll(const std::string& folder) {
  std::map<std::string, std::vector<uint8_t>> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files[std::filesystem::relative(entry.path(), folder).string()] = *ReadFileBytes(entry.path().string());
  }
  return files;
}

// Distance of p from the triangle (a, b, c).
double Distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const auto to_edge = [&p](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    const double t = std::clamp((p - u).dot(v - u) / std::max((v - u).squaredNorm(), 1e-12), 0.0, 1.0);
    return (p - u - t * (v - u)).norm();
  };
  const Eigen::Vector3d n = (b - a).cross(c - a).normalized();
  const auto inside = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) { return n.dot((v - u).cross(p - u)) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return std::abs(n.dot(p - a));
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

double DistanceFromMesh(const AGraph& house, const Eigen::Vector3d& p) {
  double best = 1e9;
  const auto vertex = [&house](uint32_t v) { return Eigen::Vector3d(house.mesh.vertices[v].cast<double>() + house.origin); };
  for (const Triangle& t : house.mesh.triangles) best = std::min(best, Distance(p, vertex(t.a), vertex(t.b), vertex(t.c)));
  return best;
}

TEST(Simulate, GivesTheSameBytesForTheSameSeed) {
  const AGraph house = test::MakeHouse();
  const test::TemporaryFolder a, b, c;
  ASSERT_TRUE(Simulate(house, Short(3), a.path()));
  ASSERT_TRUE(Simulate(house, Short(3), b.path()));
  ASSERT_TRUE(Simulate(house, Short(4), c.path()));
  const auto files = ReadAll(a.path());
  EXPECT_EQ(files.size(), 60u + 3u);
  EXPECT_TRUE(files == ReadAll(b.path()));
  EXPECT_FALSE(files == ReadAll(c.path()));
}

TEST(Simulate, WritesARecordingThatFitsItsTruth) {
  const AGraph house = test::MakeHouse();
  const test::TemporaryFolder folder;
  SimulateOptions options = Short(11);
  options.max_duration_s = options.min_duration_s = 20;
  const Expected<SimulateSummary> summary = Simulate(house, options, folder.path());
  ASSERT_TRUE(summary) << summary.error().message;
  const Expected<runtime::Recording> recording = runtime::Recording::Open(folder.path());
  ASSERT_TRUE(recording) << recording.error().message;
  const Expected<runtime::Trajectory> truth = runtime::ReadTum(folder / "truth.tum");
  ASSERT_TRUE(truth);
  ASSERT_EQ(recording->size(), summary->scans);
  ASSERT_EQ(truth->size(), summary->scans);
  EXPECT_LT(recording->odometry().front().stamp_s, recording->stamp_s(0));
  EXPECT_GT(recording->odometry().back().stamp_s, recording->stamp_s(recording->size() - 1) + 0.1);

  const AGraph built = BuildWithDeviations(house, StoreyId(0), options)->house;
  int points = 0, near = 0;
  for (size_t i = 0; i + 1 < recording->size(); i += 8) {
    EXPECT_EQ(recording->stamp_s(i), (*truth)[i].stamp_s);
    const Expected<runtime::Scan> scan = recording->Read(i);
    ASSERT_TRUE(scan);
    ASSERT_EQ(scan->time_s.size(), scan->points.size());
    ASSERT_EQ(scan->ring.size(), scan->points.size());
    ASSERT_EQ(scan->intensity.size(), scan->points.size());
    for (size_t k = 0; k < scan->points.size(); k += 37) {
      const auto T = runtime::InterpolatePose(*truth, scan->stamp_s + static_cast<double>(scan->time_s[k]));
      ASSERT_TRUE(T);
      ++points;
      if (DistanceFromMesh(built, *T * scan->points[k].cast<double>()) < 4 * 0.02) ++near;
    }
  }
  EXPECT_GT(points, 10000);
  EXPECT_GE(near, 0.998 * points);
}

TEST(Simulate, WritesWhatWasBuiltOtherwise) {
  const AGraph house = test::MakeHouse();
  const test::TemporaryFolder folder;
  const Expected<SimulateSummary> summary = Simulate(house, Short(5), folder.path());
  ASSERT_TRUE(summary);
  const nlohmann::json truth = nlohmann::json::parse(*ReadFileText(folder / "truth.json"));
  EXPECT_EQ(truth.at("version"), 1);
  EXPECT_EQ(truth.at("seed"), 5);
  ASSERT_EQ(truth.at("walls").size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    const nlohmann::json& wall = truth.at("walls")[i];
    EXPECT_EQ(wall.at("wall_guid"), house.walls[summary->walls[i].wall.index()].guid);
    EXPECT_NEAR(wall.at("translation_m").get<double>(), summary->walls[i].translation_m, 1e-6);
    EXPECT_NEAR(wall.at("rotation_deg").get<double>(), summary->walls[i].rotation_rad * 180 / M_PI, 1e-6);
    EXPECT_EQ(wall.at("surfaces").size(), summary->walls[i].surfaces.size());
  }
  const nlohmann::json& points = truth.at("surface_points");
  EXPECT_EQ(points.size(), house.surfaces.size());
  size_t inner = 0, outer = 0;
  for (size_t s = 0; s < house.surfaces.size(); ++s) {
    (house.surfaces[s].room.valid() ? inner : outer) += points.at(std::to_string(s)).get<size_t>();
  }
  EXPECT_GT(inner, summary->points / 3);
  EXPECT_EQ(outer, 0u);
  for (size_t s = 0; s < house.surfaces.size(); ++s) {
    const Surface& surface = house.surfaces[s];
    EXPECT_NEAR(truth.at("surface_seen_m2").at(std::to_string(s)).get<double>(), summary->surface_seen_m2[s], 1e-6) << s;
    EXPECT_LE(summary->surface_seen_m2[s], (surface.length_m() + 1.7) * (surface.z_max_m - surface.z_min_m + 0.2)) << s;
  }
}

TEST(Simulate, RemovesTheScansOfAnEarlierRecording) {
  const AGraph house = test::MakeHouse();
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "scans");
  ASSERT_TRUE(WriteFileAtomically(folder / "scans/0000000007.000000000.pcd", std::string_view("old")));
  const Expected<SimulateSummary> summary = Simulate(house, Short(1), folder.path());
  ASSERT_TRUE(summary);
  EXPECT_EQ(runtime::Recording::Open(folder.path())->size(), summary->scans);
}

TEST(Simulate, BrokenOffLeavesNothingOfAnEarlierRecording) {
  const AGraph house = test::MakeHouse();
  const test::TemporaryFolder folder;
  for (const char* name : {"odometry.tum", "truth.tum", "truth.json"})
    ASSERT_TRUE(WriteFileAtomically(folder / name, std::string_view("old")));
  bool stood = false;
  const Expected<SimulateSummary> summary = Simulate(house, Short(1), folder.path(), [&](size_t, size_t) {
    for (const char* name : {"odometry.tum", "truth.tum"}) stood |= std::filesystem::exists(folder / name);
    stood |= ReadFileText(folder / "truth.json").value_or("") == "old";
  });
  ASSERT_TRUE(summary);
  EXPECT_FALSE(stood) << "while scans are written";
  EXPECT_EQ(ReadFileText(folder / "truth.json").value_or("").find("incomplete"), std::string::npos);
}

TEST(Simulate, RefusesBadOptionsAndPlansWithoutRooms) {
  const test::TemporaryFolder folder;
  SimulateOptions options = Short(1);
  options.sensor = "sonar";
  EXPECT_EQ(Simulate(test::MakeHouse(), options, folder.path()).error().code, ErrorCode::kBadOption);
  EXPECT_NE(options.Check().find("SimulateOptions.sensor = sonar; must be one of vlp16"), std::string::npos) << options.Check();
  options = Short(1);
  options.max_translation_m = 0.01;
  EXPECT_NE(options.Check().find("max_translation_m"), std::string::npos);
  EXPECT_EQ(Simulate(AGraph(), Short(1), folder.path()).error().code, ErrorCode::kPlanUnsuitable);
  options = Short(1);
  options.storey = 4;
  EXPECT_EQ(Simulate(test::MakeHouse(), options, folder.path()).error().code, ErrorCode::kPlanUnsuitable);
}

}  // namespace
}  // namespace plumb::tools
