// The aliasing forecast on real plans. Skipped where they are absent.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "compiler/compile.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;
using compiler::DiagnosticKind;

class Aliases : public ::testing::Test {
 protected:
  void Compile(const std::string& name) {
    const fs::path plan = fs::path(PLUMB_SOURCE_DIR) / "../shared/data/plans/ifc" / (name + ".ifc");
    if (!fs::exists(plan)) GTEST_SKIP() << plan << " is not there";
    result_ = compiler::Compile(plan.string());
    ASSERT_TRUE(result_.graph);
  }
  [[nodiscard]] const AGraph& graph() const { return *result_.graph; }
  [[nodiscard]] std::string NameOf(RoomId room) const { return graph().rooms[room.index()].name; }
  [[nodiscard]] size_t CountOf(DiagnosticKind kind) const {
    const auto& all = result_.diagnostics.all();
    return static_cast<size_t>(std::count_if(all.begin(), all.end(), [&](const compiler::Diagnostic& d) { return d.kind == kind; }));
  }

  compiler::CompileResult result_;
};

// Two flats that map onto each other under a half turn, rooms A... onto B...
TEST_F(Aliases, TheDuplexMapsOntoItselfUnderAHalfTurn) {
  Compile("Duplex_A_20110907");
  if (IsSkipped()) return;
  ASSERT_EQ(graph().aliases.size(), 1u);
  const Alias& a = graph().aliases[0];
  EXPECT_NEAR(std::abs(a.yaw_rad), std::numbers::pi, 0.002);
  EXPECT_TRUE(a.closed);
  EXPECT_GT(a.overlap_ratio, 0.98);
  EXPECT_GE(a.rooms.size() + 1, graph().rooms.size());
  for (size_t i = 0; i < a.rooms.size(); ++i) {
    const char flat = NameOf(a.rooms[i])[0], other = NameOf(a.twins[i])[0];
    EXPECT_EQ(flat == 'A' ? 'B' : 'A', other) << NameOf(a.rooms[i]) << " on " << NameOf(a.twins[i]);
  }
  EXPECT_EQ(CountOf(DiagnosticKind::kPlanAlias), 1u);
}

// Five houses in a row, 7.505 m wide: H-1 falls on H-2, and so on.
TEST_F(Aliases, TheRowHousesMapOntoTheirNeighbours) {
  Compile("Allplan-Smiley-West");
  if (IsSkipped()) return;
  ASSERT_GE(graph().aliases.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    const Alias& a = graph().aliases[i];
    EXPECT_TRUE(a.closed);
    EXPECT_NEAR(a.yaw_rad, 0, 0.002);
    EXPECT_NEAR(std::abs(a.translation.x()), 7.505 * static_cast<double>(i + 1), 0.01);
    EXPECT_NEAR(a.translation.y(), 0, 0.01);
    EXPECT_EQ(a.rooms.size(), 14 * (4 - i));
    EXPECT_GT(a.overlap_ratio, 0.99);
  }
}

// Only the attic, one room that no doorway leads into, falls on itself; the storey where a robot enters does not.
TEST_F(Aliases, TheGroundFloorOfTheFzkHausHasNone) {
  Compile("AC20-FZK-Haus");
  if (IsSkipped()) return;
  for (const Alias& a : graph().aliases) {
    for (RoomId room : a.rooms) EXPECT_NE(graph().rooms[room.index()].storey, StoreyId(0)) << NameOf(room);
  }
  EXPECT_TRUE(graph().look_alikes.empty());
}

// Offices on three storeys, one above the other: partial, since corridors and stairs tell.
TEST_F(Aliases, TheInstituteHasStoreysThatRepeatInPart) {
  Compile("AC11-Institute-Var-2-IFC");
  if (IsSkipped()) return;
  const bool found = std::any_of(graph().aliases.begin(), graph().aliases.end(), [](const Alias& a) {
    return !a.closed && std::abs(a.translation.z() - 3) < 0.01 && a.translation.head<2>().norm() < 0.05 && a.rooms.size() >= 10;
  });
  EXPECT_TRUE(found);
  EXPECT_GE(CountOf(DiagnosticKind::kPartialAlias), 1u);
  EXPECT_GE(CountOf(DiagnosticKind::kRoomsAlike), 1u);
}

}  // namespace
}  // namespace plumb
