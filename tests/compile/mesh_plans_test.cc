// Meshes and Gazebo worlds of other people, read in place, against what a person counts in their sections; and our own plan as a mesh
// against the same plan as IFC.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "compiler/compile.h"
#include "schema/agraph_writer.h"
#include "tests/compile/by_eye.h"
#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = fs::path(PLUMB_SOURCE_DIR) / "../shared/data/plans";
const fs::path kOffice = fs::path(PLUMB_SOURCE_DIR) / "plans/site_office";

AGraph CompileFine(const fs::path& path, CompileOptions options = {}) {
  options.verify_stages = true;
  CompileResult result = Compile(path.string(), options);
  EXPECT_TRUE(result.graph) << DiagnosticsToText(result.diagnostics.all(), path.string());
  EXPECT_FALSE(result.diagnostics.has_errors()) << DiagnosticsToText(result.diagnostics.all(), path.string());
  return result.graph ? std::move(*result.graph) : AGraph();
}

// Read in sections of the meshes themselves at the heights of sills, of a person's chest and of lintels.
const test::ByEye kMeshes[] = {
    {"mesh/1st_build_EX_114551_1st_floor.dae",
     1,
     {{-0.3, 0.3}, {-0.9, 7.65}, {0, 4}, {4, 6}},
     {{0.8, 1.9}, {0.2, 7.55}, {1.43, 2.9}, {0.83, 8.3}, {-2.1, 5.2}, {-2.1, 9.65}, {-0.3, 12.9}, {3.7, 12.9}, {5.9, 5.9}, {6.15, 1.2}}},
    {"mesh/47_basement_pbp.stl",
     1,
     {{-0.2, 9.5}, {3.7, 9.5}, {-0.2, 6.7}, {-0.2, 4.1}, {-1.05, 2}, {0, 0}, {3.7, 3}},
     {{0.95, 8}, {2.3, 8}, {1.63, 6.65}, {0.35, 2.7}, {-0.25, 2.1}, {1.63, -1.2}, {-1.9, -1.6}, {-0.3, -2.2}}},
    {"mesh/oetrange_top_floor.ply",
     1,
     {{-0.4, 0.3}, {3.1, 1.2}, {3.1, 6}, {3.5, 9.4}, {3.5, 11.7}, {-0.4, 10.6}, {-0.9, 7.6}, {-0.9, 4}},
     {{0.8, 1.9},
      {1.42, 2.55},
      {1.42, 5},
      {1.42, 9.4},
      {1.42, 12.2},
      {0.8, 8.3},
      {0.2, 7.55},
      {-2.1, 5.95},
      {2.55, 12.9},
      {-0.6, -1.55},
      {4, -1.55},
      {5.85, 9.45}}},
    {"mesh/aws_hospital_floor_01_walls_collision.dae",
     1,
     {{0, 12},   {-4.5, 17},   {4.5, 17},   {-9.3, 14.5},  {9.3, 14.5},  {-10.8, 10}, {10.8, 10},  {-10.8, 6}, {10.8, 6},
      {-10, -3}, {10, -3},     {-7.2, 0.8}, {7.2, 0.8},    {-10, -17},   {10, -17},   {-7.2, -13}, {7.2, -13}, {-9.5, -28},
      {4, -29},  {-1.2, -3.5}, {1.2, -3.5}, {-1.8, -11.5}, {1.8, -11.5}, {-1.8, -19}, {1.8, -19}},
     {{-5.2, 15},  {5.2, 15},  {-6.7, 12},  {6.7, 12},  {-9, 11.2},    {9, 11.2},    {-9, 4.8},    {9, 4.8},     {-6.5, -9}, {6.5, -9},
      {-7.2, -.5}, {7.2, -.5}, {-6.5, -23}, {6.5, -23}, {-7.2, -14.5}, {7.2, -14.5}, {-6.5, -25},  {-7.45, -32}, {5.4, -26}, {-2.55, -32},
      {-2.8, 0},   {2.8, 0},   {-2.8, -10}, {2.8, -10}, {-2.8, -16},   {2.8, -16},   {-1.5, 19.4}, {1.5, 19.4}},
     0,
     2,
     0,
     2,
     "the wall between the two flights of each stairwell stops 2.8 m before its outer wall, which has a jamb there: a wide doorway parts "
     "the upper flight from the landing"},
    {"mesh/aws_small_house_walls_collision.dae", 1, {{-6, -1}, {3.4, -1}, {1, 4.4}}, {{-2.6, -1.2}, {6, -5.6}, {1.2, 3.2}}},
    {"sdf/turtlebot3_house_model.sdf",
     1,
     {{-6.2, 3}, {-6.2, -1.5}, {-2.5, 2.5}, {1.1, 3}, {5, 2.5}, {6.2, -2.7}},
     {{-6.3, 0.95}, {-5.15, 3.3}, {2.3, 4.6}, {2.3, 0.4}, {6.2, -0.17}, {1.1, -0.17}}}};

class MeshSamples : public testing::TestWithParam<test::ByEye> {};

TEST_P(MeshSamples, HasTheRoomsAndDoorwaysThatAPersonSees) {
  const test::ByEye& expected = GetParam();
  const fs::path path = kShared / expected.path;
  if (!fs::exists(path)) GTEST_SKIP() << "no sample plan " << path;
  const test::Compared compared = test::Compare(expected, CompileFine(path));
  EXPECT_EQ(compared.rooms_missed, expected.rooms_missed) << compared.text;
  EXPECT_EQ(compared.rooms_added, expected.rooms_added) << compared.text;
  EXPECT_EQ(compared.doorways_missed, expected.doorways_missed) << compared.text;
  EXPECT_EQ(compared.doorways_added, expected.doorways_added) << compared.text;
}

std::string NameOfSample(const testing::TestParamInfo<test::ByEye>& info) {
  std::string name = fs::path(info.param.path).stem().string();
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, MeshSamples, testing::ValuesIn(kMeshes), NameOfSample);

// The entry of `others` that `distance` finds nearest.
template <class Item, class Distance>
double Least(const std::vector<Item>& others, const Distance& distance) {
  double least = 1e9;
  for (const Item& o : others) least = std::min(least, distance(o));
  return least;
}

TEST(SiteOffice, AsAMeshHasTheRoomsDoorwaysAndSurfacesOfTheIfcWithinACentimetre) {
  const AGraph ifc = CompileFine(kOffice / "plan.ifc"), mesh = CompileFine(kOffice / "plan.obj");
  ASSERT_EQ(mesh.rooms.size(), ifc.rooms.size());
  ASSERT_EQ(mesh.doorways.size(), ifc.doorways.size());
  ASSERT_EQ(mesh.windows.size(), ifc.windows.size());
  ASSERT_EQ(mesh.walls.size(), ifc.walls.size());
  EXPECT_EQ(mesh.surfaces.size(), ifc.surfaces.size());
  for (const Room& r : ifc.rooms) {
    EXPECT_LT(Least(mesh.rooms, [&](const Room& m) { return (m.center - r.center).norm() + std::abs(m.area_m2 - r.area_m2); }), 0.01)
        << r.name;
  }
  for (const Doorway& d : ifc.doorways) {
    EXPECT_LT(Least(mesh.doorways, [&](const Doorway& m) { return (m.position - d.position).norm() + std::abs(m.width_m - d.width_m); }),
              0.01)
        << d.name;
  }
  for (const Surface& s : ifc.surfaces) {
    EXPECT_LT(Least(mesh.surfaces, [&](const Surface& m) { return (m.start - s.start).norm() + (m.end - s.end).norm(); }), 0.01)
        << s.midpoint().transpose();
  }
}

TEST(SiteOffice, AsAMeshNamesItsWallsAsTheObjects) {
  const AGraph mesh = CompileFine(kOffice / "plan.obj");
  const auto has = [&](const char* name) {
    return std::any_of(mesh.walls.begin(), mesh.walls.end(), [&](const Wall& w) { return w.guid == name; });
  };
  for (const char* name : {"South", "North", "West", "East", "Corridor_south", "Between_offices"}) EXPECT_TRUE(has(name)) << name;
}

std::string ReadText(const fs::path& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

// The office with every corner mapped; `drop_objects`: one soup.
std::string MappedOffice(double scale, bool y_up, bool drop_objects, bool mixed_facing = false) {
  std::istringstream in(ReadText(kOffice / "plan.obj"));
  std::ostringstream out;
  std::string line;
  size_t faces = 0;
  while (std::getline(in, line)) {
    double x = 0, y = 0, z = 0;
    int a = 0, b = 0, c = 0, d = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
      out << "v " << scale * x << ' ' << scale * (y_up ? z : y) << ' ' << scale * (y_up ? -y : z) << '\n';
    } else if (mixed_facing && std::sscanf(line.c_str(), "f %d %d %d %d", &a, &b, &c, &d) == 4 && ++faces % 2 == 0) {
      out << "f " << d << ' ' << c << ' ' << b << ' ' << a << '\n';
    } else if (!drop_objects || line[0] != 'o') {
      out << line << '\n';
    }
  }
  return out.str();
}

AGraph CompileText(const std::string& text, const std::string& name, const CompileOptions& options = {}) {
  const test::TemporaryFolder folder;
  const fs::path path = fs::path(folder.path()) / name;
  std::ofstream(path, std::ios::binary) << text;
  return CompileFine(path, options);
}

void ExpectOffice(const AGraph& graph) {
  EXPECT_EQ(graph.rooms.size(), 7u);
  EXPECT_EQ(graph.doorways.size(), 9u);
  EXPECT_EQ(graph.windows.size(), 8u);
  double area_m2 = 0;
  for (const Room& r : graph.rooms) area_m2 += r.area_m2;
  EXPECT_NEAR(area_m2, 91.2, 0.2);
}

TEST(MeshUnits, OfMillimetresAreSeenInTheWalls) { ExpectOffice(CompileText(MappedOffice(1000, false, false), "plan.obj")); }
TEST(MeshUnits, OfFeetAreSeenInTheWalls) { ExpectOffice(CompileText(MappedOffice(1 / 0.3048, false, false), "plan.obj")); }
TEST(MeshUnits, AreTakenAsStated) {
  CompileOptions options;
  options.unit = "in";
  ExpectOffice(CompileText(MappedOffice(1 / 0.0254, false, false), "plan.obj", options));
}
TEST(MeshAxes, OfAYUpMeshAreSeenInItsHeights) { ExpectOffice(CompileText(MappedOffice(1, true, false), "plan.obj")); }
TEST(MeshSoup, OfAllWallsInOneObjectGivesTheRooms) { ExpectOffice(CompileText(MappedOffice(1, false, true), "plan.obj")); }
TEST(MeshSoup, WithFacesEitherWayRoundGivesTheRooms) { ExpectOffice(CompileText(MappedOffice(1, false, true, true), "plan.obj")); }

// The office twice, 2.9 m apart, each on a slab.
TEST(MeshStoreys, AreToldFromTheirFloors) {
  std::ostringstream out;
  size_t corners = 0;
  for (const double floor_m : {0.0, 2.9}) {
    const size_t base = corners;
    std::istringstream in(ReadText(kOffice / "plan.obj"));
    std::string line;
    while (std::getline(in, line)) {
      double x = 0, y = 0, z = 0;
      size_t a = 0, b = 0, c = 0, d = 0;
      if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
        out << "v " << x << ' ' << y << ' ' << z + floor_m << '\n';
        ++corners;
      } else if (std::sscanf(line.c_str(), "f %zu %zu %zu %zu", &a, &b, &c, &d) == 4) {
        out << "f " << a + base << ' ' << b + base << ' ' << c + base << ' ' << d + base << '\n';
      } else {
        out << line << '_' << floor_m << '\n';
      }
    }
    out << "o floor_" << floor_m << '\n';
    for (const auto& [x, y] : {std::pair(24.97, 39.46), std::pair(35.05, 47.02), std::pair(29.89, 53.9), std::pair(19.81, 46.34)})
      out << "v " << x << ' ' << y << ' ' << floor_m << '\n';
    corners += 4;
    out << "f " << corners - 3 << ' ' << corners - 2 << ' ' << corners - 1 << ' ' << corners << '\n';
  }
  const AGraph graph = CompileText(out.str(), "plan.obj");
  ASSERT_EQ(graph.storeys.size(), 2u);
  EXPECT_NEAR(graph.storeys[1].elevation_m, 2.9, 1e-3);
  EXPECT_EQ(graph.rooms.size(), 14u);
  EXPECT_EQ(graph.doorways.size(), 18u);
}

TEST(MeshPlans, CompileToTheSameBytesEachTime) {
  const AGraph once = CompileFine(kOffice / "plan.obj"), again = CompileFine(kOffice / "plan.obj");
  EXPECT_EQ(WriteAGraph(once), WriteAGraph(again));
}

// Errors, not graphs, and soon.
void ExpectRefused(const std::string& text, const std::string& name, DiagnosticKind kind) {
  const test::TemporaryFolder folder;
  const fs::path path = fs::path(folder.path()) / name;
  std::ofstream(path, std::ios::binary) << text;
  const CompileResult result = Compile(path.string());
  EXPECT_FALSE(result.graph) << name;
  const auto& all = result.diagnostics.all();
  EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const Diagnostic& d) { return d.kind == kind; })) << DiagnosticsToText(all, name);
}

TEST(HostileMeshes, AreRefused) {
  ExpectRefused(std::string("\xff\xd8\xff\xe0\0\x10JFIF\0", 12) + std::string(5000, '\x7f'), "photo.obj", DiagnosticKind::kUnknownFormat);
  ExpectRefused(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n",
      "cut.ply", DiagnosticKind::kMeshWithoutTriangles);
  ExpectRefused("o w\nv 0 0 0\nv 1 0 0\nv 1 1e20 0\nf 1 2 3\n", "far.obj", DiagnosticKind::kMeshNotFinite);
  ExpectRefused("glTF\2\0\0\0", "cut.glb", DiagnosticKind::kMeshUnreadable);
}

TEST(HostileMeshes, WithTooManyTrianglesAreRefused) {
  std::string text = "o w\n";
  for (int i = 0; i < 1000; ++i)
    text += "v " + std::to_string(i % 10) + " " + std::to_string(i / 10 % 10) + " " + std::to_string(i / 100) + "\n";
  for (int i = 0; i < 1600000; ++i) text += "f 1 2 " + std::to_string(3 + i % 990) + "\n";
  ExpectRefused(text, "huge.obj", DiagnosticKind::kMeshTooLarge);
}

}  // namespace
}  // namespace plumb::compiler
