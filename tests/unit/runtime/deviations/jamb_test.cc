#include "runtime/deviations/jamb.h"

#include <gtest/gtest.h>

#include <random>

namespace plumb::runtime {
namespace {

constexpr double kJamb_m = 0.083, kFine_m = 0.006;

// Sights of a wall that ends at kJamb_m: `keyframes` sweeps, each with its own phase.
class View {
 public:
  // Points of the face from -0.4 m up to `end_m`.
  void Face(int side, double spacing_m, int keyframes, double end_m = kJamb_m) {
    for (int k = 0; k < keyframes; ++k) {
      for (double x = -0.4 + spacing_m * Uniform(); x < end_m; x += spacing_m) evidence.AddFace(side, x + 0.003 * Normal(), kFine_m, Id(k));
    }
  }
  // Lines from `begin_m` to `end_m`.
  void Passed(double spacing_m, int keyframes, double begin_m = kJamb_m, double end_m = 0.5) {
    for (int k = 0; k < keyframes; ++k) {
      for (double x = begin_m + spacing_m * Uniform(); x < end_m; x += spacing_m) evidence.AddPassed(x + 0.003 * Normal(), kFine_m, Id(k));
    }
  }
  void Inside(int points, double at_m, double spread_m) {
    for (int i = 0; i < points; ++i) evidence.AddInside(at_m + spread_m * Normal(), spread_m, Id(i));
  }

  JambEvidence evidence{0.5, 0.5};

 private:
  static uint32_t Id(int k) { return static_cast<uint32_t>(k); }
  double Uniform() { return static_cast<double>(random_() % 10000) / 10000; }
  double Normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += Uniform();
    return sum;
  }
  std::mt19937 random_{7};
};

TEST(EstimateJamb, LiesBetweenWhatIsSeenOfTheWallAndWhatPasses) {
  View view;
  view.Face(0, 0.05, 20);
  view.Passed(0.01, 20);
  const JambEstimate jamb = EstimateJamb(view.evidence, 0);
  ASSERT_TRUE(jamb.known);
  EXPECT_NEAR(jamb.x_m, kJamb_m, 0.005);
  EXPECT_NEAR(jamb.x_m, kJamb_m, 2 * jamb.sigma_m);
}

TEST(EstimateJamb, ManyMoreLinesOfOneKindDoNotPushIt) {
  View view;
  view.Face(0, 0.05, 10);
  view.Passed(0.001, 60);
  const JambEstimate jamb = EstimateJamb(view.evidence, 0);
  ASSERT_TRUE(jamb.known);
  EXPECT_NEAR(jamb.x_m, kJamb_m, 0.005);
}

TEST(EstimateJamb, CoarseSamplesWidenItsSigma) {
  View fine, coarse;
  fine.Face(0, 0.01, 10);
  fine.Passed(0.01, 10);
  coarse.Face(0, 0.05, 3);  // a sweep at 5 m, thinned
  coarse.Passed(0.05, 3);
  const JambEstimate known = EstimateJamb(fine.evidence, 0), rough = EstimateJamb(coarse.evidence, 0);
  ASSERT_TRUE(known.known);
  EXPECT_GT(rough.sigma_m, known.sigma_m);
  EXPECT_NEAR(rough.x_m, kJamb_m, 3 * rough.sigma_m);
}

TEST(EstimateJamb, TheJambsOwnFaceIsEnoughWhereTheWallIsHidden) {
  View view;
  view.Inside(60, kJamb_m, 0.01);
  view.Passed(0.01, 20);
  const JambEstimate jamb = EstimateJamb(view.evidence, 0);
  ASSERT_TRUE(jamb.known);
  EXPECT_NEAR(jamb.x_m, kJamb_m, 0.006);
}

TEST(EstimateJamb, IsUnknownWithoutAnythingThatPasses) {
  View view;
  view.Face(0, 0.02, 20);
  EXPECT_FALSE(EstimateJamb(view.evidence, 0).known);
}

TEST(EstimateJamb, IsUnknownFromOneSweep) {
  View view;
  view.Face(0, 0.01, 1);
  view.Passed(0.01, 1);
  EXPECT_FALSE(EstimateJamb(view.evidence, 0).known);
}

TEST(EstimateJamb, ALeafThatStandsInTheOpeningIsNoJamb) {
  View view;  // from 15 cm before what passes up to it; the jamb at 0 is seen on the other face
  view.Face(0, 0.02, 10, 0.0);
  view.Passed(0.01, 20, 0.25);
  view.Inside(80, 0.20, 0.02);
  const JambEstimate jamb = EstimateJamb(view.evidence, 0);
  EXPECT_TRUE(!jamb.known || std::abs(jamb.x_m) < 2 * jamb.sigma_m);
}

TEST(EstimateJamb, ALiningThatThePlanLacksIsNoNarrowerDoorway) {
  View view;
  view.Face(0, 0.02, 20, 0.0);
  view.Face(1, 0.02, 20, 0.0);
  view.Inside(60, 0.02, 0.01);
  view.Inside(60, 0.04, 0.01);
  view.Passed(0.01, 20, 0.04);
  const JambEstimate jamb = EstimateJamb(view.evidence, 0);
  EXPECT_NEAR(jamb.x_m, 0.02, 0.01);
  EXPECT_LT(std::abs(jamb.x_m), 2 * jamb.sigma_m);
  // Where the plan has it, the wall ends as planned and so does the lining.
  EXPECT_NEAR(EstimateJamb(view.evidence, 0.04).x_m, 0.04, 0.01);
}

TEST(EstimateJamb, FacesThatEndAtDifferentPlacesAreNoJamb) {
  View view;
  view.Face(0, 0.01, 20, 0.0);
  view.Face(1, 0.01, 20, 0.1);  // a board stands before the opening
  view.Passed(0.01, 20, 0.1);
  EXPECT_FALSE(EstimateJamb(view.evidence, 0).known);
}

TEST(EstimateJamb, CoarseSigmasDoNotPushIt) {
  JambEvidence evidence(0.5, 0.5);  // evenly spread, sharp, and taken for much coarser
  for (uint32_t k = 0; k < 60; ++k) {
    const double phase = (k % 12) / 12.0;
    for (int i = 0; i < 25; ++i) evidence.AddPassed(kJamb_m + 0.012 * (i + phase), 0.015, k);
    for (int i = 0; i < 10; ++i) evidence.AddFace(0, kJamb_m - 0.036 * (i + phase), 0.015, k);
  }
  EXPECT_NEAR(EstimateJamb(evidence, 0).x_m, kJamb_m, 0.006);
}

TEST(EstimateJamb, SaysWhetherTheRevealIsSeenThere) {
  View reveal, casing;
  for (View* view : {&reveal, &casing}) {
    view->Face(0, 0.02, 20);
    view->Face(1, 0.02, 20);
    view->Passed(0.01, 20);
  }
  reveal.Inside(60, kJamb_m, 0.006);
  casing.Inside(60, kJamb_m - 0.06, 0.006);
  EXPECT_TRUE(EstimateJamb(reveal.evidence, 0).on_reveal);
  EXPECT_FALSE(EstimateJamb(casing.evidence, 0).on_reveal);
}

TEST(ConfirmJamb, HoldsWhereLinesPassUpToItAndNotBeyond) {
  View view;
  view.Passed(0.01, 20);
  EXPECT_TRUE(ConfirmJamb(view.evidence, kJamb_m, 0.004).known);
  EXPECT_FALSE(ConfirmJamb(view.evidence, kJamb_m + 0.15, 0.004).known) << "lines pass behind it";
  EXPECT_FALSE(ConfirmJamb(view.evidence, kJamb_m - 0.10, 0.004).known) << "nothing passes beside it";
  EXPECT_FALSE(ConfirmJamb(view.evidence, kJamb_m, 0.05).known);
}

TEST(JambOptions, NamesTheFieldThatIsWrong) {
  EXPECT_EQ(JambOptions().Check(), "");
  JambOptions options;
  options.correlation = 0;
  EXPECT_EQ(options.Check(), "JambOptions.correlation = 0; must be >= 1");
}

}  // namespace
}  // namespace plumb::runtime
