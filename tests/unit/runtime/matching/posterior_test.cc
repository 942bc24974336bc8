#include "runtime/matching/posterior.h"

#include <gtest/gtest.h>

namespace plumb::runtime {
namespace {

using Verdict = MatchResult::Verdict;

// A pose that nothing speaks against, at `x_m`.
Candidate Good(double log_likelihood, double x_m = 0) {
  Candidate c;
  c.fit.pose.t_m.x() = x_m;
  c.fit.pairs.resize(10);
  c.fit.consistent_planes = 10;
  c.fit.consistent_ratio = 0.9;
  c.fit.information = c.fit.place_information = 1e6 * Eigen::Matrix3d::Identity();
  c.fit.scale_error = 0;
  c.fit.sigma_scale = 0.002;
  c.rays.log_likelihood = log_likelihood;
  c.rays.explained_ratio = 0.8;
  c.rays.judged = 1000;
  return c;
}

MatchResult Decided(const std::vector<Candidate>& candidates, const WrongPlans& wrong = {}) {
  return Decide(SortAndMerge(candidates), MapView(), AGraph(), MatcherOptions(), wrong);
}

TEST(SortAndMerge, KeepsTheBestOfEachPlace) {
  const std::vector<Candidate> kept = SortAndMerge({Good(10, 5), Good(50, 0.1), Good(80, 0), Good(20, 5.2)});
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept[0].rays.log_likelihood, 80);
  EXPECT_EQ(kept[1].rays.log_likelihood, 20);
}

TEST(Decide, OneGoodPlaceIsUnique) {
  const MatchResult result = Decided({Good(100), Good(20, 5)});
  EXPECT_EQ(result.verdict, Verdict::kUnique) << result.reason;
  EXPECT_GT(result.hypotheses.front().probability, 0.9999);
}

TEST(Decide, TwoPlacesAlikeAreAmbiguous) {
  const MatchResult result = Decided({Good(100), Good(98, 5)});
  EXPECT_EQ(result.verdict, Verdict::kAmbiguous);
  EXPECT_NEAR(result.hypotheses[0].probability / result.hypotheses[1].probability, std::exp(2.0), 1e-6);
}

// As a hint sees them: the one as the robot's start, the other not.
MatchResult DecidedWithHint(double hinted, double other) {
  Candidate a = Good(hinted), b = Good(other, 5);
  a.log_prior = 0.7;
  b.log_prior = -6.9;
  return Decided({a, b});
}

TEST(Decide, AHintTellsApartWhatTheEvidenceDoesNot) {
  EXPECT_EQ(DecidedWithHint(100, 100).verdict, Verdict::kUnique);
  EXPECT_EQ(DecidedWithHint(100, 100.5).verdict, Verdict::kUnique);
  EXPECT_EQ(DecidedWithHint(100, 103).verdict, Verdict::kAmbiguous) << "the evidence prefers the other";
  const MatchResult overruled = DecidedWithHint(100, 120);
  EXPECT_EQ(overruled.verdict, Verdict::kUnique);
  EXPECT_NEAR(overruled.hypotheses.front().log_likelihood, 120 - 6.9, 1e-9);
}

TEST(Decide, NoHintHoweverStrongOverrulesTheEvidence) {
  Candidate hinted = Good(100), other = Good(102, 5);
  hinted.log_prior = 11;
  other.log_prior = -6.9;
  EXPECT_EQ(Decided({hinted, other}).verdict, Verdict::kAmbiguous);
}

TEST(Decide, AHintIsNoEvidenceForThePlan) {
  Candidate poor = Good(9);
  poor.log_prior = 5;
  EXPECT_EQ(Decided({poor}).verdict, Verdict::kSearching);
}

TEST(Decide, OutsideThePlanWinsOverAPoorPlace) {
  const MatchResult result = Decided({Good(1)});
  EXPECT_EQ(result.verdict, Verdict::kSearching);
  EXPECT_NEAR(result.probability_outside, 1 / (1 + std::exp(1.0)), 1e-9);
}

TEST(Decide, AMirrorImageThatFitsAsWellForbidsTheFix) {
  WrongPlans wrong;
  wrong.mirrored = 99;
  const MatchResult result = Decided({Good(100)}, wrong);
  EXPECT_EQ(result.verdict, Verdict::kSearching);
  EXPECT_NE(result.reason.find("mirror"), std::string::npos) << result.reason;
}

TEST(Decide, WithoutASurePlanScaleOnlyRaysThatTellItAllowTheFix) {
  Candidate unsure = Good(100);
  unsure.fit.sigma_scale = 0.1;
  EXPECT_EQ(Decided({unsure}).verdict, Verdict::kSearching);
  const double needed = MatcherOptions().vouch_lead_nats;
  WrongPlans wrong;
  wrong.scaled = 100 - needed + 1;
  EXPECT_EQ(Decided({unsure}, wrong).verdict, Verdict::kSearching) << "a plan of another scale fits nearly as well";
  wrong.scaled = 100 - needed - 1;
  EXPECT_EQ(Decided({unsure}, wrong).verdict, Verdict::kUnique);
}

TEST(Decide, APlanOfAnotherScaleIsNeverTheBuildings) {
  Candidate scaled = Good(100);
  scaled.fit.scale_error = 0.03;
  const MatchResult result = Decided({scaled});
  EXPECT_EQ(result.verdict, Verdict::kSearching);
  EXPECT_NE(result.reason.find("scale"), std::string::npos) << result.reason;
}

TEST(Decide, APlanOfAnotherSizeThatFitsBetterForbidsTheFixWhateverTheWallsSay) {
  const Candidate sure_walls = Good(100);
  ASSERT_TRUE(WallsTellScale(sure_walls.fit, MatcherOptions()));
  WrongPlans wrong;
  wrong.scaled = 100 + MatcherOptions().accept_scale_loss_nats + 1;
  const MatchResult result = Decided({sure_walls}, wrong);
  EXPECT_EQ(result.verdict, Verdict::kSearching);
  EXPECT_NE(result.reason.find("another size"), std::string::npos) << result.reason;
  wrong.scaled = 100;
  EXPECT_EQ(Decided({sure_walls}, wrong).verdict, Verdict::kUnique) << "the walls tell";
}

TEST(Decide, WhereWallsDoNotFixThePlaceRaysMayThatTellItFromThoseNearby) {
  const MatcherOptions options;
  Candidate loose = Good(100);
  loose.fit.information = loose.fit.place_information = Eigen::Vector3d(1e6, 0, 1e6).asDiagonal();
  EXPECT_FALSE(WallsFixPlace(loose.fit, options));
  EXPECT_EQ(Decided({loose}).verdict, Verdict::kSearching);
  loose.lead_nearby = options.accept_margin_nats - 1;
  const MatchResult unsure = Decided({loose});
  EXPECT_EQ(unsure.verdict, Verdict::kSearching);
  EXPECT_NE(unsure.reason.find("too few walls"), std::string::npos) << unsure.reason;
  loose.lead_nearby = options.accept_margin_nats + 1;
  const MatchResult sure = Decided({loose});
  EXPECT_EQ(sure.verdict, Verdict::kUnique) << sure.reason;
  EXPECT_NEAR(sure.hypotheses.front().sigma_xy_m, options.nearby_m / std::sqrt(22.0), 1e-9);
  EXPECT_LT(sure.hypotheses.front().sigma_yaw_rad, 0.002) << "the walls tell";
}

TEST(WallsTellScale, OnlyWhereTheyAgreeWithThePlansToo) {
  const MatcherOptions options;
  WallFit fit;
  fit.sigma_scale = 0.0044;
  fit.scale_error = 0.003;
  EXPECT_TRUE(WallsTellScale(fit, options));
  fit.scale_error = -0.0089;  // of a plan 3 % too large, whose farther walls pass for deviated ones
  EXPECT_FALSE(WallsTellScale(fit, options));
  fit.sigma_scale = 0.02;
  EXPECT_FALSE(WallsTellScale(fit, options));
  fit.sigma_scale = 0.0005;
  fit.scale_error = 0.003;  // of ranges, in a large map
  EXPECT_TRUE(WallsTellScale(fit, options));
}

TEST(RaysVouch, OnlyFarAheadOfTheRivalAndTheMirrorImage) {
  const MatcherOptions options;
  EXPECT_TRUE(RaysVouch({Good(100), Good(20, 5)}, {}, options));
  EXPECT_FALSE(RaysVouch({Good(100), Good(80, 5)}, {}, options)) << "a rival is near";
  EXPECT_FALSE(RaysVouch({Good(100), Good(20, 5)}, {80, {}}, options)) << "the mirror image is near";
  EXPECT_FALSE(RaysVouch({Good(300), Good(300 - 0.9 * options.vouch_lead_ratio * 300, 5)}, {}, options))
      << "a small part of what both explain";
  Candidate nearly_all = Good(300);
  nearly_all.rays.explained_ratio = options.vouch_nearly_all_ratio;
  EXPECT_TRUE(RaysVouch({nearly_all, Good(300 - options.vouch_lead_nats, 5)}, {}, options));
  Candidate blind = Good(100);
  blind.rays.explained_ratio = 0.5;
  EXPECT_FALSE(RaysVouch({blind}, {}, options)) << "too few rays end where they should";
}

TEST(RaysVouch, FurnitureCountsNeitherWay) {
  const MatcherOptions options;
  Candidate furnished = Good(100);
  furnished.rays.explained_ratio = 0.45;
  furnished.rays.in_front_ratio = 0.4;
  EXPECT_TRUE(RaysVouch({furnished}, {}, options));
  furnished.rays.in_front_ratio = 0.2;
  EXPECT_FALSE(RaysVouch({furnished}, {}, options)) << "many of the others end where the plan has nothing";
}

TEST(RaysVouch, AmongFurnitureOnlyFurtherAhead) {
  const MatcherOptions options;
  Candidate c = Good(1.5 * options.vouch_lead_nats);
  c.rays.in_front_ratio = 0.2;
  EXPECT_TRUE(RaysVouch({c}, {}, options));
  c.rays.in_front_ratio = 0.5;
  EXPECT_FALSE(RaysVouch({c}, {}, options));
  c.rays.log_likelihood = 2.1 * options.vouch_lead_nats;
  EXPECT_TRUE(RaysVouch({c}, {}, options));
}

TEST(RaysVouch, AmongFurnitureNotFurtherAheadWhereWallsAndRaysHoldThePlace) {
  const MatcherOptions options;
  Candidate c = Good(1.5 * options.vouch_lead_nats);
  c.rays.in_front_ratio = 0.5;
  c.fit.consistent_planes = options.accept_min_planes;
  EXPECT_FALSE(RaysVouch({c}, {}, options)) << "not asked for";
  EXPECT_TRUE(MayVouch({c}, {}, options));
  c.lead_nearby = options.accept_margin_nats - 1;
  EXPECT_FALSE(MayVouch({c}, {}, options));
  c.lead_nearby = options.accept_margin_nats;
  EXPECT_TRUE(RaysVouch({c}, {}, options));
  c.fit.consistent_planes -= 1;
  EXPECT_FALSE(RaysVouch({c}, {}, options)) << "too few walls";
}

TEST(RaysVouch, BySmallerLeadsWhereNothingNearbyAndNoOtherSizeFits) {
  const MatcherOptions options;
  const double sharp = options.vouch_sharp_ratio * 300;
  ASSERT_LT(1.1 * sharp, options.vouch_lead_ratio * 300);
  const auto vouch = [&](double lead, double nearby, double size, double mirror) {
    Candidate best = Good(300);
    best.lead_nearby = nearby;
    return RaysVouch({best, Good(300 - lead, 5)}, {300 - mirror, 300 - size}, options);
  };
  const double more = 1.1 * sharp, less = 0.9 * sharp;
  EXPECT_TRUE(vouch(more, more, more, more));
  EXPECT_FALSE(vouch(less, more, more, more)) << "another place";
  EXPECT_FALSE(vouch(more, less, more, more)) << "a place nearby";
  EXPECT_FALSE(vouch(more, more, less, more)) << "another size";
  EXPECT_FALSE(vouch(more, more, more, less)) << "the mirror image";
  EXPECT_FALSE(RaysVouch({Good(300), Good(300 - more, 5)}, {}, options)) << "nothing was asked for";
  EXPECT_TRUE(MayVouch({Good(300), Good(300 - more, 5)}, {}, options));
  EXPECT_FALSE(MayVouch({Good(300), Good(300 - less, 5)}, {}, options));
}

TEST(Doubt, FewPlanesAreEnoughOnlyWhereRaysVouch) {
  Candidate few = Good(100);
  few.fit.consistent_planes = MatcherOptions().vouch_min_planes;
  EXPECT_EQ(Decided({few}).verdict, Verdict::kUnique);
  few.rays.explained_ratio = 0.5;
  EXPECT_EQ(Decided({few}).verdict, Verdict::kSearching);
}

TEST(Doubt, RaysThroughWallsAreForgivenWhereMorePlanesAgreeThanAreAskedFor) {
  const MatcherOptions options;
  Candidate c = Good(100);
  c.rays.through_ratio = 0.5 * (options.accept_max_through_ratio + options.vouch_max_through_ratio);
  const auto doubt = [&] { return Doubt(c, Hypothesis(), c.fit.consistent_planes - options.ample_more_planes, {}, std::nullopt, options); };
  EXPECT_EQ(doubt(), "");
  EXPECT_NE(Doubt(c, Hypothesis(), c.fit.consistent_planes, {}, std::nullopt, options), "") << "just as many as asked for";
  c.fit.consistent_ratio = 0.5 * options.accept_min_consistent_ratio;
  EXPECT_NE(doubt(), "") << "most walls are elsewhere";
  c.fit.consistent_ratio = 0.9;
  c.rays.through_ratio = 1.1 * options.vouch_max_through_ratio;
  EXPECT_NE(doubt(), "");
}

TEST(SizeDoubt, WallsMustTellTheSizeByMoreThanRaysAreAgainstIt) {
  const MatcherOptions options;
  Candidate c = Good(100);
  c.fit.sigma_scale = options.accept_scale_error / 6;  // 18 nats
  EXPECT_EQ(SizeDoubt(c, std::nullopt, options), "");
  EXPECT_EQ(SizeDoubt(c, 105.0, options), "");
  EXPECT_NE(SizeDoubt(c, 110.0, options), "") << "the rays prefer another size";
  c.fit.sigma_scale = options.accept_scale_error / 4;  // 8 nats
  EXPECT_NE(SizeDoubt(c, 20.0, options), "") << "a bent map's rays do not tell the size";
  c.fit.sigma_scale = options.accept_scale_error / 6;
  c.fit.scale_error = -options.accept_scale_error / 2;
  EXPECT_NE(SizeDoubt(c, std::nullopt, options), "");
  c.fit.scale_error = 2 * options.accept_scale_error;
  EXPECT_NE(SizeDoubt(c, std::nullopt, options), "");
}

TEST(SizeDoubt, NoWallsMakeUpForRaysThatFitAnotherSizeFarBetter) {
  const MatcherOptions options;
  Candidate c = Good(100);
  c.fit.sigma_scale = options.accept_scale_error / 20;  // 200 nats
  EXPECT_EQ(SizeDoubt(c, 100 * (1 + 0.9 * options.vouch_lead_ratio), options), "");
  EXPECT_NE(SizeDoubt(c, 100 * (1 + 1.1 * options.vouch_lead_ratio), options), "");
}

TEST(Decide, AsksAPlanarMapForItsSize) {
  Candidate c = Good(100);
  c.fit.sigma_scale = 0.007;  // enough for another map
  MapView planar;
  planar.planar = true;
  EXPECT_EQ(Decide({c}, MapView(), AGraph(), MatcherOptions()).verdict, Verdict::kUnique);
  EXPECT_EQ(Decide({c}, planar, AGraph(), MatcherOptions()).verdict, Verdict::kSearching);
  c.fit.sigma_scale = 0.002;
  EXPECT_EQ(Decide({c}, planar, AGraph(), MatcherOptions()).verdict, Verdict::kUnique);
  WrongPlans larger;
  larger.scaled = 120;
  EXPECT_EQ(Decide({c}, planar, AGraph(), MatcherOptions(), larger).verdict, Verdict::kUnique) << "the walls tell it by more";
}

TEST(Decide, APlanarMapMustNotLieBetterBesideThePlaceEvenWhereWallsFixIt) {
  const MatcherOptions options;
  Candidate c = Good(100);
  MapView planar;
  planar.planar = true;
  ASSERT_TRUE(WallsFixPlace(c.fit, options));
  c.lead_nearby = -1;
  EXPECT_EQ(Decide({c}, MapView(), AGraph(), options).verdict, Verdict::kUnique);
  const MatchResult torn = Decide({c}, planar, AGraph(), options);
  EXPECT_EQ(torn.verdict, Verdict::kSearching);
  EXPECT_NE(torn.reason.find("beside it"), std::string::npos) << torn.reason;
  c.lead_nearby = 1;
  EXPECT_EQ(Decide({c}, planar, AGraph(), options).verdict, Verdict::kUnique);
}

TEST(StandsAlone, OnlyWhereAllOtherPlacesAreNoBetterThanOutside) {
  const MatcherOptions options;
  EXPECT_TRUE(StandsAlone({Good(options.vouch_lead_nats), Good(0, 5), Good(-80, 9)}, 0, options));
  EXPECT_FALSE(StandsAlone({Good(options.vouch_lead_nats - 1), Good(-80, 5)}, 0, options)) << "hardly fits itself";
  EXPECT_FALSE(StandsAlone({Good(300), Good(-80, 5), Good(1, 9)}, 0, options)) << "the rays fit elsewhere as well";
  EXPECT_FALSE(StandsAlone({Good(300), Good(-80, 5)}, 1, options)) << "the rays fit the mirror image as well";
  EXPECT_FALSE(StandsAlone({Good(300)}, 0, options)) << "nothing to compare with";
}

// Among boxes: half of the rays end on them, and most of what was seen upright are their sides.
Candidate Cluttered(const MatcherOptions& options) {
  Candidate c = Good(60);
  c.fit.consistent_ratio = 0.5 * options.accept_min_consistent_ratio;
  c.rays.explained_ratio = 0.5;
  c.rays.in_front_ratio = 0.4;
  return c;
}

TEST(Decide, AmongClutterAPlaceThatStandsAloneIsUnique) {
  const Candidate cluttered = Cluttered(MatcherOptions());
  const MatchResult alone = Decided({cluttered, Good(-20, 5)});
  EXPECT_EQ(alone.verdict, Verdict::kUnique) << alone.reason;
  const MatchResult rivalled = Decided({cluttered, Good(60 - 0.9 * MatcherOptions().vouch_lead_nats, 5)});
  EXPECT_EQ(rivalled.verdict, Verdict::kSearching);
  EXPECT_NE(rivalled.reason.find("of the walls seen agree"), std::string::npos) << rivalled.reason;
}

TEST(Doubt, OfAPlaceThatStandsAloneOnlyTheShareOfWallsIsForgiven) {
  const MatcherOptions options;
  const RayVerdict alone{false, true};
  const int planes = Good(0).fit.consistent_planes;
  const auto doubt = [&](const Candidate& c, int required) { return Doubt(c, Hypothesis(), required, alone, std::nullopt, options); };
  Candidate cluttered = Cluttered(options);
  EXPECT_EQ(doubt(cluttered, planes), "");
  EXPECT_NE(doubt(cluttered, planes + 1), "") << "planes are asked for as anywhere";
  cluttered.rays.through_ratio = 1.1 * options.accept_max_through_ratio;
  EXPECT_NE(doubt(cluttered, planes - options.ample_more_planes), "") << "few walls agree, and rays pass through others";
}

TEST(RequiredPlanes, GrowWithTheNumberOfRooms) {
  const MatcherOptions options;
  EXPECT_EQ(RequiredPlanes(1, 0, options), options.accept_min_planes);
  EXPECT_EQ(RequiredPlanes(1000, 0, options), options.accept_min_planes + 3);
  EXPECT_EQ(RequiredPlanes(1000, std::log(100), options), options.accept_min_planes + 1) << "a hint leaves ten of them";
  EXPECT_EQ(RequiredPlanes(1000, -7, options), options.accept_min_planes + 3) << "a place that the hint speaks against";
}

}  // namespace
}  // namespace plumb::runtime
