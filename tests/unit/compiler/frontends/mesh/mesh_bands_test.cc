#include "compiler/frontends/mesh/mesh_bands.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/compiler/frontends/mesh/scenes.h"

namespace plumb::compiler {
namespace {

const FaceDirection kAlongX;

// Faces of one object, from a to b with the solid on the left, at one height.
SectionStack FacesOf(const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& faces) {
  SectionStack out{{1.0}, {{}}};
  for (const auto& [a, b] : faces) out.segments[0].push_back({a, b, 0});
  return out;
}

std::vector<Band> BandsOf(const SectionStack& stack, Facing facing) { return FindBands({kAlongX}, stack, {0}, facing, {}); }

void ExpectBand(const Band& band, double c0_m, double c1_m, double s0_m, double s1_m) {
  EXPECT_NEAR(band.c0_m, c0_m, 1e-9);
  EXPECT_NEAR(band.c1_m, c1_m, 1e-9);
  ASSERT_EQ(band.spans[0].size(), 1u);
  EXPECT_NEAR(band.spans[0][0].s0_m, s0_m, 1e-9);
  EXPECT_NEAR(band.spans[0][0].s1_m, s1_m, 1e-9);
}

TEST(MeshBands, AreTheSolidBetweenTwoFacesWhicheverWayTheMeshIsTurned) {
  const SectionStack outward = FacesOf({{{0, 0}, {5, 0}}, {{5, 0.2}, {0, 0.2}}});
  const SectionStack inward = FacesOf({{{5, 0}, {0, 0}}, {{0, 0.2}, {5, 0.2}}});
  for (const auto& [stack, facing] : {std::pair(outward, Facing::kOutward), {inward, Facing::kInward}, {outward, Facing::kUnknown}}) {
    const auto bands = BandsOf(stack, facing);
    ASSERT_EQ(bands.size(), 1u);
    EXPECT_FALSE(bands[0].sheet);
    ExpectBand(bands[0], 0, 0.2, 0, 5);
  }
}

TEST(MeshBands, TheFreeSpaceBetweenTwoWallsIsNone) {
  const auto bands =
      BandsOf(FacesOf({{{0, 0}, {5, 0}}, {{5, 0.2}, {0, 0.2}}, {{0, 0.5}, {5, 0.5}}, {{5, 0.7}, {0, 0.7}}}), Facing::kOutward);
  ASSERT_EQ(bands.size(), 2u);
  ExpectBand(bands[0], 0, 0.2, 0, 5);
  ExpectBand(bands[1], 0.5, 0.7, 0, 5);
}

TEST(MeshBands, OfUnknownFacesTheNearestMakeAWall) {
  const auto bands = BandsOf(FacesOf({{{0, 0}, {5, 0}}, {{0, 0.5}, {5, 0.5}}, {{0, 0.6}, {5, 0.6}}}), Facing::kUnknown);
  const auto wall = std::find_if(bands.begin(), bands.end(), [](const Band& b) { return !b.sheet; });
  ASSERT_NE(wall, bands.end());
  ExpectBand(*wall, 0.5, 0.6, 0, 5);
  EXPECT_EQ(std::count_if(bands.begin(), bands.end(), [](const Band& b) { return b.sheet; }), 1);
}

TEST(MeshBands, AFaceWithoutPartnerIsASheetBehindIt) {
  const MeshOptions options;
  const auto south = BandsOf(FacesOf({{{0, 0}, {5, 0}}}), Facing::kOutward);  // solid to the north of it
  ASSERT_EQ(south.size(), 1u);
  EXPECT_TRUE(south[0].sheet);
  ExpectBand(south[0], 0, options.sheet_thickness_m, 0, 5);
  const auto unknown = BandsOf(FacesOf({{{0, 0}, {5, 0}}}), Facing::kUnknown);
  ASSERT_EQ(unknown.size(), 1u);
  ExpectBand(unknown[0], -0.5 * options.sheet_thickness_m, 0.5 * options.sheet_thickness_m, 0, 5);
}

TEST(MeshBands, FacesTooFarApartAreTwoSheets) {
  const auto bands = BandsOf(FacesOf({{{0, 0}, {5, 0}}, {{5, 1.5}, {0, 1.5}}}), Facing::kOutward);
  ASSERT_EQ(bands.size(), 2u);
  EXPECT_TRUE(bands[0].sheet && bands[1].sheet);
}

TEST(MeshBands, GoOnThroughGapsThatNothingCaps) {
  // Another wall ends at the north side between x = 2 and x = 2.2, as deep as the south face stops too.
  const auto bands = BandsOf(FacesOf({{{0, 0}, {5, 0}}, {{5, 0.2}, {2.2, 0.2}}, {{2, 0.2}, {0, 0.2}}}), Facing::kOutward);
  const auto wall = std::find_if(bands.begin(), bands.end(), [](const Band& b) { return !b.sheet; });
  ASSERT_NE(wall, bands.end());
  ExpectBand(*wall, 0, 0.2, 0, 5);
}

TEST(MeshBands, EndAtTheCapsOfADoorway) {
  const auto bands = BandsOf(FacesOf({{{0, 0}, {2, 0}}, {{2, 0}, {2, 0.2}}, {{2, 0.2}, {0, 0.2}},  // one side of it
                                      {{2.5, 0}, {5, 0}}, {{5, 0.2}, {2.5, 0.2}}, {{2.5, 0.2}, {2.5, 0}}}), Facing::kOutward);
  ASSERT_EQ(bands.size(), 1u);
  ASSERT_EQ(bands[0].spans[0].size(), 2u);
  EXPECT_NEAR(bands[0].spans[0][0].s1_m, 2, 1e-9);
  EXPECT_NEAR(bands[0].spans[0][1].s0_m, 2.5, 1e-9);
}

TEST(MeshBands, ReachIntoCornersAlongTheOuterFace) {
  const auto bands = BandsOf(FacesOf({{{0, 0}, {5, 0}}, {{4.8, 0.2}, {0.2, 0.2}}}), Facing::kOutward);
  const auto wall = std::find_if(bands.begin(), bands.end(), [](const Band& b) { return !b.sheet; });
  ASSERT_NE(wall, bands.end());
  ExpectBand(*wall, 0, 0.2, 0, 5);
}

TEST(MeshBands, GroupsMakeWallsOfTheirOwn) {
  SectionStack stack = FacesOf({{{0, 0}, {5, 0}}, {{5, 0.2}, {0, 0.2}}});
  stack.segments[0][1].object = 1;
  const auto together = FindBands({kAlongX}, stack, {0, 0}, Facing::kOutward, {});
  ASSERT_EQ(together.size(), 1u);
  EXPECT_FALSE(together[0].sheet);
  const auto apart = FindBands({kAlongX}, stack, {1, 2}, Facing::kOutward, {});
  ASSERT_EQ(apart.size(), 2u);
  EXPECT_TRUE(apart[0].sheet && apart[1].sheet);
  EXPECT_EQ(apart[0].group, 1u);
  EXPECT_EQ(apart[1].group, 2u);
}

}  // namespace
}  // namespace plumb::compiler
