// Every diagnostic has a smallest input that provokes it and the text that it then prints: golden/diagnostics/CODE.ifc (or another
// ending) and CODE.txt. What no drawing can provoke, since only a damaged A-Graph or the file system does, is made here.
// PLUMB_UPDATE_GOLDEN=1 rewrites the texts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <numbers>
#include <set>

#include "compiler/frontends/mesh/mesh_options.h"
#include "compiler/validate.h"
#include "schema/agraph_reader.h"
#include "schema/agraph_writer.h"
#include "schema/files.h"
#include "tests/support/house.h"
#include "tests/support/temporary_folder.h"

namespace plumb::compiler {
namespace {

namespace fs = std::filesystem;

const fs::path kGoldens = fs::path(PLUMB_SOURCE_DIR) / "tests/compile/golden/diagnostics";

AGraph Changed(const std::function<void(AGraph&)>& change) {
  AGraph house = test::MakeHouse();
  change(house);
  return house;
}

// A half turn about (4.5, 3) takes rooms A and B onto B and A, as it seems.
Alias AliasOf(const AGraph& g, bool closed) {
  Alias alias;
  alias.yaw_rad = std::numbers::pi;
  alias.translation = {9, 6, 0};
  alias.overlap_ratio = 0.97;
  alias.from_storey = alias.to_storey = StoreyId(0);
  alias.rooms = {RoomId(0), RoomId(1)};
  alias.twins = {RoomId(1), RoomId(0)};
  alias.tolerance_m = 0.06;
  alias.section_length_m = 31;
  alias.closed = closed;
  alias.differences = {ElementId(g.elements.size() - 1)};
  return alias;
}

using Maker = std::function<AGraph()>;

// A-Graphs that no compilation gives.
const std::map<std::string, Maker>& Graphs() {
  static const std::map<std::string, Maker> kGraphs = {
      {"PL7101", [] { return Changed([](AGraph& g) { std::swap(g.rooms[0].polygon[0], g.rooms[0].polygon[1]); }); }},
      {"PL7102",
       [] {
         return Changed([](AGraph& g) {
           for (auto& p : g.rooms[1].polygon) p.y() -= 1;
         });
       }},
      {"PL7104", [] { return Changed([](AGraph& g) { g.rooms[2].surfaces.clear(); }); }},
      {"PL7105", [] { return Changed([](AGraph& g) { g.doorways[0].room_b = g.doorways[0].room_a; }); }},
      {"PL7106", [] { return Changed([](AGraph& g) { g.surfaces[g.rooms[0].surfaces[0].index()].start.y() -= 0.1; }); }},
      {"PL7107", [] { return Changed([](AGraph& g) { g.rooms[0].surfaces.erase(g.rooms[0].surfaces.begin()); }); }},
      {"PL7108", [] { return Changed([](AGraph& g) { g.doorways[1].position.x() += 2; }); }},
      {"PL7109", [] { return Changed([](AGraph& g) { g.rooms[2].ceiling_z_m = -1; }); }},
      {"PL7201", [] { return Changed([](AGraph& g) { g.aliases = {AliasOf(g, true)}; }); }},
      {"PL7202", [] { return Changed([](AGraph& g) { g.aliases = {AliasOf(g, false)}; }); }},
      {"PL7203", [] { return Changed([](AGraph& g) { g.look_alikes = {{{RoomId(0), RoomId(1)}}}; }); }},
      {"PL8005", [] { return Changed([](AGraph& g) { g.surfaces[3].wall = WallId(99); }); }},
  };
  return kGraphs;
}

void WriteDamaged(const std::string& name) {
  std::vector<uint8_t> bytes = WriteAGraph(test::MakeHouse());
  bytes[bytes.size() / 2] ^= 1;
  ASSERT_TRUE(WriteFileAtomically(name, bytes));
}

// Another writer's future major version: the first number that the reader takes for it.
void WriteTooNew(const std::string& name) {
  std::vector<uint8_t> bytes = WriteAGraph(test::MakeHouse());
  for (size_t at = 8; at + 4 <= bytes.size(); at += 4) {
    if (bytes[at] != kSchemaMajor) continue;
    bytes[at] = kSchemaMajor + 1;
    const Expected<AGraph> read = ReadAGraph(bytes);
    if (!read && read.error().code == ErrorCode::kAGraphTooNew) break;
    bytes[at] = kSchemaMajor;
  }
  ASSERT_TRUE(WriteFileAtomically(name, bytes));
}

void WriteHuge(const std::string& name) {
  ASSERT_TRUE(WriteFileAtomically(name, std::string_view("ISO-10303-21;\n")));
  fs::resize_file(name, uintmax_t{3} << 30);  // a hole: takes no room on the disk
}

// One triangle, again and again.
void WriteManyTriangles(const std::string& name) {
  std::string text = "v 0 0 0\nv 4 0 0\nv 0 0 3\n";
  for (size_t i = 0; i <= MeshOptions().max_triangles; ++i) text += "f 1 2 3\n";
  ASSERT_TRUE(WriteFileAtomically(name, std::string_view(text)));
}

// The input is in the working folder afterwards. Its name; empty: there is none.
std::string Provide(const std::string& code) {
  for (const char* ending : {".ifc", ".ifc.gz", ".dxf", ".svg", ".agraph", ".obj", ".ply", ".dae", ".sdf"}) {
    const fs::path stored = kGoldens / (code + ending);
    if (!fs::exists(stored)) continue;
    fs::copy_file(stored, code + ending);
    return code + ending;
  }
  const std::string graph = code + ".agraph", plan = code + ".ifc";
  if (const auto maker = Graphs().find(code); maker != Graphs().end()) {
    EXPECT_TRUE(WriteAGraphFile(maker->second(), graph));
    return graph;
  }
  if (code == "PL1001") return plan;
  if (code == "PL1003") return WriteHuge(plan), plan;
  if (code == "PL4002") return WriteManyTriangles(code + ".obj"), code + ".obj";
  if (code == "PL8003") return WriteDamaged(graph), graph;
  if (code == "PL8004") return WriteTooNew(graph), graph;
  if (code == "PL9001") return plan;
  return {};
}

class DiagnosticsGolden : public testing::TestWithParam<DiagnosticKind> {
 protected:
  void SetUp() override {
    before_ = fs::current_path();
    fs::current_path(folder_.path());
  }
  void TearDown() override { fs::current_path(before_); }

  test::TemporaryFolder folder_;
  fs::path before_;
};

TEST_P(DiagnosticsGolden, SmallestInputGivesTheText) {
  const std::string code = CodeOf(GetParam());
  const std::string input = Provide(code);
  ASSERT_FALSE(input.empty()) << "there is no " << code << ".ifc in " << kGoldens;
  ValidateOptions options;
  if (GetParam() == DiagnosticKind::kInternalError) options.compile.snap_radius_m = -1;  // as only a caller can
  if (GetParam() == DiagnosticKind::kLayerRulesUnreadable) options.compile.drawing.layers = "germna";
  if (GetParam() == DiagnosticKind::kPlanTooComplex) options.compile.drawing.max_paths = 2;
  if (GetParam() == DiagnosticKind::kSheetMissing) options.compile.drawing.sheet = 3;
  // Storeys are given by callers, too.
  const Report report = GetParam() == DiagnosticKind::kStoreysCollide
                            ? ReportOf(input, CompileStoreys({{"EG", input, 0.0}, {"OG", input, 0.5}}, {}))
                            : ValidateFile(input, options);
  std::vector<Diagnostic> found;
  std::copy_if(report.diagnostics.begin(), report.diagnostics.end(), std::back_inserter(found),
               [](const Diagnostic& d) { return d.kind == GetParam(); });
  const std::string text = DiagnosticsToText(found, input, found.size());
  ASSERT_FALSE(found.empty()) << "the input does not provoke it, but:\n" << ReportToString(report, ReportFormat::kText);
  const std::string golden = (kGoldens / (code + ".txt")).string();
  if (const char* update = std::getenv("PLUMB_UPDATE_GOLDEN"); update != nullptr && std::string(update) == "1") {
    ASSERT_TRUE(WriteFileAtomically(golden, std::string_view(text)));
    GTEST_SKIP() << "rewrote " << golden;
  }
  const Expected<std::string> expected = ReadFileText(golden);
  ASSERT_TRUE(expected) << expected.error().message << "; PLUMB_UPDATE_GOLDEN=1 writes it";
  EXPECT_EQ(text, *expected) << "PLUMB_UPDATE_GOLDEN=1 rewrites the golden file";
}

std::string NameOfTest(const testing::TestParamInfo<DiagnosticKind>& info) { return CodeOf(info.param) + std::string(NameOf(info.param)); }

INSTANTIATE_TEST_SUITE_P(EveryKind, DiagnosticsGolden, testing::ValuesIn(AllDiagnosticKinds().begin(), AllDiagnosticKinds().end()),
                         NameOfTest);

TEST(DiagnosticsGoldens, BelongToKindsThatThereAre) {
  for (const auto& entry : fs::directory_iterator(kGoldens)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(FindDiagnosticKind(name.substr(0, name.find('.')))) << name;
  }
}

}  // namespace
}  // namespace plumb::compiler
