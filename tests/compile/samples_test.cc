// Real plans of other people, read in place where they are: what must hold for every one of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "compiler/compile.h"
#include "compiler/validate.h"
#include "schema/agraph_reader.h"
#include "schema/agraph_writer.h"

namespace plumb::compiler {
namespace {

const std::string kFolder = PLUMB_SOURCE_DIR "/../shared/data/plans/ifc/";

CompileResult CompileSample(const std::string& name) {
  CompileOptions options;
  options.verify_stages = true;
  return Compile(kFolder + name, options);
}

class Samples : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << "no sample plans in " << kFolder;
  }
};

TEST_F(Samples, EveryPlanCompilesToAConsistentGraph) {
  for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
    const std::string name = entry.path().filename();
    if (entry.path().extension() != ".ifc") continue;
    const CompileResult result = CompileSample(name);
    ASSERT_TRUE(result.graph.has_value()) << name << "\n" << DiagnosticsToText(result.diagnostics.all(), name);
    for (const Diagnostic& d : result.diagnostics.all()) EXPECT_NE(d.severity, Severity::kError) << name << ": " << d.message;
    const Expected<AGraph> read = ReadAGraph(WriteAGraph(*result.graph));
    EXPECT_TRUE(read) << name << ": " << read.error().message;
  }
}

// Rooms, of them named by a space, doorways, of them leading from a room to another room or outside.
struct Counts {
  size_t rooms = 0, named = 0, doorways = 0, joining = 0;
};

Counts CountsOf(const AGraph& graph) {
  Counts out{graph.rooms.size(), 0, graph.doorways.size(), 0};
  for (const Room& r : graph.rooms) out.named += !r.guid.empty();
  for (const Doorway& d : graph.doorways) out.joining += d.room_a.valid() && d.room_a != d.room_b;
  return out;
}

TEST_F(Samples, RoomsAndDoorsOfFaithfulPlansAreAllFound) {
  struct Expectation {
    const char* file;
    size_t spaces, doors;  // as in the source
  };
  for (const Expectation& e : {Expectation{"AC20-FZK-Haus.ifc", 7, 5}, Expectation{"AC11-Institute-Var-2-IFC.ifc", 82, 77},
                               Expectation{"Allplan-Smiley-West.ifc", 70, 85}, Expectation{"Duplex_A_20110907.ifc", 20, 14},
                               Expectation{"Office_A_20110811.ifc", 99, 102}}) {
    const CompileResult result = CompileSample(e.file);
    ASSERT_TRUE(result.graph.has_value()) << e.file;
    const Counts counts = CountsOf(*result.graph);
    EXPECT_GE(counts.named, e.spaces) << e.file;
    EXPECT_GE(counts.doorways, e.doors) << e.file;
    EXPECT_EQ(counts.joining, counts.doorways) << e.file;
  }
}

TEST_F(Samples, DoorsWithoutRelationsStandInTheirWalls) {
  const CompileResult result = CompileSample("jgs_fhnw_model.ifc");
  ASSERT_TRUE(result.graph.has_value());
  const Counts counts = CountsOf(*result.graph);
  EXPECT_EQ(counts.joining, counts.doorways);
  const auto& doorways = result.graph->doorways;
  EXPECT_EQ(std::count_if(doorways.begin(), doorways.end(), [](const Doorway& d) { return d.has_leaf; }), 21);
}

}  // namespace
}  // namespace plumb::compiler
