// Real IFC files: the KIT house of Debian's assimp-testmodels, and others where a folder of them is at hand. Skipped where they are absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "compiler/frontends/ifc/ifc_frontend.h"
#include "compiler/geometry/csg.h"

namespace plumb::compiler {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> FindFzkHaus() {
  for (const char* path : {"/usr/share/assimp/models/IFC/AC14-FZK-Haus.ifc", "/usr/share/assimp/models/IFC/AC14-FZK-Haus.ifc.gz"}) {
    if (fs::exists(path)) return path;
  }
  return std::nullopt;
}

size_t CountGuids(const PlanIr& plan, ElementKind kind) {
  std::set<std::string> guids;
  for (const PlanElement& e : plan.elements) {
    if (e.kind == kind) guids.insert(e.guid);
  }
  return guids.size();
}

class FzkHaus : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto path = FindFzkHaus();
    if (!path) GTEST_SKIP() << "the Debian package assimp-testmodels is not installed";
    const auto source = LoadSource(*path, diagnostics_);
    ASSERT_TRUE(source);
    plan_ = ReadIfc(*source, diagnostics_);
    ASSERT_TRUE(plan_);
  }

  DiagnosticSink diagnostics_;
  std::optional<PlanIr> plan_;
};

TEST_F(FzkHaus, CountsAndStoreys) {
  EXPECT_EQ(plan_->source_format, "IFC2X3");
  ASSERT_EQ(plan_->storeys.size(), 2u);
  EXPECT_NEAR(plan_->storeys[0].elevation_m, 0, 1e-9);
  EXPECT_NEAR(plan_->storeys[1].elevation_m, 2.7, 1e-9);
  EXPECT_EQ(CountGuids(*plan_, ElementKind::kWall), 13u);
  EXPECT_EQ(CountGuids(*plan_, ElementKind::kDoor), 5u);
  EXPECT_EQ(CountGuids(*plan_, ElementKind::kWindow), 11u);
  EXPECT_EQ(plan_->spaces.size(), 7u);
  EXPECT_EQ(plan_->openings.size(), 17u);
  EXPECT_EQ(std::count_if(plan_->openings.begin(), plan_->openings.end(), [](const PlanOpening& o) { return o.filling != kNoIndex; }), 16);
  EXPECT_EQ(std::count_if(plan_->elements.begin(), plan_->elements.end(),
                          [](const PlanElement& e) { return e.kind == ElementKind::kWindow && e.material == Material::kGlass; }),
            11);
  for (const PlanElement& e : plan_->elements) {
    if (e.kind != ElementKind::kWall) continue;
    EXPECT_NE(e.storey, kNoIndex) << e.name;
  }
  EXPECT_FALSE(diagnostics_.has_errors());
}

// Walls of the ground floor are mitred prisms: volumes by hand from the drawing (12 m x 10 m, 0.3 m thick, 2.7 m high).
TEST_F(FzkHaus, WallsAreClosedAndOfTheirVolume) {
  double outer_m3 = 0;
  for (const PlanElement& e : plan_->elements) {
    if (e.kind != ElementKind::kWall) continue;
    EXPECT_TRUE(IsClosed(e.uncut)) << e.name;
    EXPECT_TRUE(IsClosed(e.body)) << e.name;
    EXPECT_GT(Volume(e.uncut), 1) << e.name;
    EXPECT_TRUE(e.thickness_m && e.axis) << e.name;
    if (e.name.find("Ext-ERDG") != std::string::npos) outer_m3 += Volume(e.uncut);
  }
  EXPECT_NEAR(outer_m3, (12 * 10 - 11.4 * 9.4) * 2.7, 1e-3);
}

// The cut is checked against the overlap of wall and opening, each opening being a box of its own.
TEST_F(FzkHaus, BodiesAreUncutLessTheirOpenings) {
  for (size_t w = 0; w < plan_->elements.size(); ++w) {
    const PlanElement& wall = plan_->elements[w];
    if (wall.kind != ElementKind::kWall) continue;
    double openings_m3 = 0;
    for (const PlanOpening& opening : plan_->openings) {
      if (opening.wall != w) continue;
      const Expected<Solid> outside = Subtract(opening.body, wall.uncut);
      ASSERT_TRUE(outside);
      const double inside_m3 = Volume(opening.body) - Volume(*outside);
      EXPECT_GT(inside_m3, 0.1) << wall.name;
      openings_m3 += inside_m3;
    }
    EXPECT_NEAR(Volume(wall.body), Volume(wall.uncut) - openings_m3, 1e-4) << wall.name;
  }
}

TEST_F(FzkHaus, SpacesFitInsideTheHouse) {
  double ground_m3 = 0;
  for (const PlanSpace& space : plan_->spaces) {
    EXPECT_TRUE(IsClosed(space.body)) << space.name;
    EXPECT_GT(Volume(space.body), 5) << space.name;
    ASSERT_NE(space.storey, kNoIndex);
    if (space.storey == 0) ground_m3 += Volume(space.body);
  }
  EXPECT_GT(ground_m3, 0.85 * 11.4 * 9.4 * 2.5);
  EXPECT_LT(ground_m3, 11.4 * 9.4 * 2.5);
}

// Other people's files with counts by an independent reader.
TEST(SharedIfcFiles, CountsAgreeWithAnIndependentReader) {
  const fs::path folder = fs::path(PLUMB_SOURCE_DIR) / "../shared/data/plans/ifc";
  if (!fs::exists(folder / "facts.json")) GTEST_SKIP() << "there is no folder of shared IFC files beside the repository";
  std::ifstream stream(folder / "facts.json");
  for (const auto& facts : nlohmann::json::parse(stream)) {
    const std::string name = facts["file"];
    SCOPED_TRACE(name);
    const auto start = std::chrono::steady_clock::now();
    DiagnosticSink diagnostics;
    const auto source = LoadSource((folder / name).string(), diagnostics);
    ASSERT_TRUE(source);
    const std::optional<PlanIr> plan = ReadIfc(*source, diagnostics);
    ASSERT_TRUE(plan);
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 20);  // seconds even on a busy machine
    const auto& counts = facts["counts"];
    EXPECT_EQ(plan->storeys.size(), counts["storeys"].get<size_t>());
    EXPECT_EQ(plan->spaces.size(), counts["spaces"].get<size_t>());
    EXPECT_EQ(CountGuids(*plan, ElementKind::kWall), counts["walls"].get<size_t>());
    EXPECT_EQ(CountGuids(*plan, ElementKind::kDoor), counts["doors"].get<size_t>());
    std::set<std::string> windows;
    for (const PlanElement& e : plan->elements) {
      if (e.type.starts_with("IfcWindow")) windows.insert(e.guid);
    }
    EXPECT_EQ(windows.size(), counts["windows"].get<size_t>());
    for (const PlanElement& e : plan->elements) {
      if (e.kind != ElementKind::kWall) continue;
      EXPECT_TRUE(IsClosed(e.uncut)) << e.guid;
      EXPECT_GT(Volume(e.uncut), 0) << e.guid;
      EXPECT_LE(Volume(e.body), Volume(e.uncut) + 1e-6) << e.guid;
    }
    if (!facts["walls_bbox_m"].is_null()) {
      Eigen::AlignedBox3d box;
      for (const PlanElement& e : plan->elements) {
        if (e.kind == ElementKind::kWall) box.extend(Bounds(e.body));
      }
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(box.min()[k] + plan->origin[k], facts["walls_bbox_m"][static_cast<size_t>(k)].get<double>(), 0.01) << k;
        EXPECT_NEAR(box.max()[k] + plan->origin[k], facts["walls_bbox_m"][static_cast<size_t>(k + 3)].get<double>(), 0.01) << k;
      }
    }
  }
}

class SharedDoors : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(folder())) GTEST_SKIP() << "there is no folder of shared IFC files beside the repository";
  }
  static fs::path folder() { return fs::path(PLUMB_SOURCE_DIR) / "../shared/data/plans/ifc"; }
};

// Without the panes in them. Some programs give several doors one GlobalId.
std::vector<const PlanElement*> DoorsOf(const PlanIr& plan) {
  std::vector<const PlanElement*> out;
  for (const PlanElement& e : plan.elements) {
    if (e.type.starts_with("IfcDoor") && (out.empty() || out.back()->location.step_id != e.location.step_id)) out.push_back(&e);
  }
  return out;
}

std::string WithoutOperations(std::string text) {
  for (const std::string operation : {".SINGLE_SWING_LEFT.", ".SINGLE_SWING_RIGHT.", ".DOUBLE_DOOR_SINGLE_SWING."}) {
    for (size_t at = text.find(operation); at != std::string::npos; at = text.find(operation, at))
      text.replace(at, operation.size(), ".NOTDEFINED.");
  }
  return text;
}

// What the files state, and what their plan symbols draw where they state nothing. The figures are counts of IfcDoor, IfcDoorStyle and
// IfcDoorType in the files' texts.
TEST_F(SharedDoors, MostDoorsSayHowTheyOpen) {
  struct Expectation {
    const char* file;
    size_t doors, known;
  };
  for (const Expectation& e :
       {Expectation{"AC11-Institute-Var-2-IFC.ifc", 77, 77}, Expectation{"AC20-FZK-Haus.ifc", 5, 4}, Expectation{"Jesse.1.ifc", 61, 61},
        Expectation{"MAD_SCIENTIST_212.ifc", 10, 10}, Expectation{"jgs_fhnw_model.ifc", 21, 18},
        Expectation{"Allplan-Smiley-West.ifc", 85, 85}, Expectation{"brunopostle_creative-freedom.ifc", 6, 6},
        Expectation{"revit2012_janesville_restaurant.ifc", 40, 32}}) {
    SCOPED_TRACE(e.file);
    DiagnosticSink diagnostics;
    const auto source = LoadSource((folder() / e.file).string(), diagnostics);
    ASSERT_TRUE(source);
    const std::optional<PlanIr> plan = ReadIfc(*source, diagnostics);
    ASSERT_TRUE(plan);
    const auto doors = DoorsOf(*plan);
    EXPECT_EQ(doors.size(), e.doors);
    EXPECT_EQ(std::count_if(doors.begin(), doors.end(), [](const PlanElement* d) { return !d->leaves.empty(); }),
              static_cast<std::ptrdiff_t>(e.known));
  }
}

// Two ways to the same knowledge: OperationType with the door's placement, and the swings in its plan symbol.
TEST_F(SharedDoors, DoorsSwingAsTheirSymbolsAreDrawn) {
  for (const auto& [file, doors] : {std::pair{"Duplex_A_20110907.ifc", 14}, std::pair{"Office_A_20110811.ifc", 102}}) {
    SCOPED_TRACE(file);
    DiagnosticSink diagnostics;
    const auto source = LoadSource((folder() / file).string(), diagnostics);
    ASSERT_TRUE(source);
    const std::string text = WithoutOperations(source->bytes);
    ASSERT_EQ(text.find("SINGLE_SWING"), std::string::npos);
    const auto stated = ReadIfc(*source, diagnostics);
    const auto drawn = ReadIfc(Source{.path = file, .bytes = text, .sha256 = "", .format = source->format}, diagnostics);
    ASSERT_TRUE(stated && drawn);
    const auto a = DoorsOf(*stated), b = DoorsOf(*drawn);
    ASSERT_EQ(a.size(), static_cast<size_t>(doors));
    ASSERT_EQ(b.size(), a.size());
    for (size_t i = 0; i < a.size(); ++i) {
      ASSERT_FALSE(a[i]->leaves.empty()) << a[i]->name;
      ASSERT_EQ(a[i]->leaves.size(), b[i]->leaves.size()) << a[i]->name;
      for (size_t k = 0; k < a[i]->leaves.size(); ++k) {
        EXPECT_LT((a[i]->leaves[k].to_jamb - b[i]->leaves[k].to_jamb).norm(), 1e-6) << a[i]->name;
        EXPECT_LT((a[i]->leaves[k].opens_to - b[i]->leaves[k].opens_to).norm(), 1e-6) << a[i]->name;
      }
    }
  }
}

}  // namespace
}  // namespace plumb::compiler
