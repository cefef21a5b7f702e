#include "lowlap/scale/internal/search/ratio_profile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::Gather;
using testing::MakeSyntheticTriplet;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

RatioProfile Profile(const TripletView& view) {
  const Result<RatioProfile> profile = ProfileRatio(view, Gather(view));
  EXPECT_TRUE(profile.has_value());
  return *profile;
}

SyntheticTripletOptions Mixed() {
  SyntheticTripletOptions options;
  options.num_points = 20;
  options.num_lines = 15;
  options.num_lines_ij = options.num_lines_jk = 30;
  options.noise_px = 0.5;
  options.wrong_share = 0.2;
  return options;
}

TEST(RatioProfile, TheModeIsTheLeastOfTheNodes) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const SyntheticTriplet triplet = MakeSyntheticTriplet(Mixed(), seed);
    const RatioProfile profile = Profile(triplet.view);
    ASSERT_GT(profile.nodes.size(), 200u);
    for (std::size_t n = 1; n < profile.nodes.size(); ++n) {
      EXPECT_LT(profile.nodes[n - 1].log_ratio, profile.nodes[n].log_ratio);
      EXPECT_GE(profile.nodes[n].nfa.log10_nfa,
                profile.mode.nfa.log10_nfa - 0.01);
    }
    EXPECT_NEAR(profile.mode.log_ratio, triplet.true_log_ratio, 0.02);
    EXPECT_LT(profile.ratio.IntervalLow(), profile.ratio.log_ratio);
    EXPECT_GT(profile.ratio.IntervalHigh(), profile.ratio.log_ratio);
    if (!profile.second_mode) continue;
    // There is a pass between the two.
    const auto [low, high] =
        std::minmax(profile.mode.log_ratio, profile.second_mode->log_ratio);
    double highest = -1e9;
    for (const RatioOptimum& node : profile.nodes) {
      if (node.log_ratio < low || node.log_ratio > high) continue;
      highest = std::max(highest, node.nfa.log10_nfa);
    }
    EXPECT_GE(highest, profile.second_mode->nfa.log10_nfa + 1 - 1e-9);
    EXPECT_GE(profile.second_mode->nfa.log10_nfa, profile.mode.nfa.log10_nfa);
  }
}

TEST(RatioProfile, SharesOfInformationAreThoseOfTheKindsThatThereAre) {
  const SyntheticTriplet triplet = MakeSyntheticTriplet(Mixed(), 1);
  const ScaleRatio ratio = Profile(triplet.view).ratio;
  double sum = 0;
  for (const KindSupport& kind : ratio.kinds) {
    EXPECT_EQ(kind.information_share > 0, kind.candidates > 0) << kind.kind;
    sum += kind.information_share;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  SyntheticTripletOptions points;
  points.num_points = 20;
  points.noise_px = 0.5;
  const RatioProfile only = Profile(MakeSyntheticTriplet(points, 1).view);
  EXPECT_EQ(only.ratio.FindKind("points")->information_share, 1);
}

// Two groups of points, each right about a ratio of its own.
TEST(RatioProfile, TheSecondModeIsTheRatioOfTheSmallerGroup) {
  SyntheticTripletOptions options;
  options.num_points = 40;
  options.noise_px = 0.3;
  SyntheticTriplet triplet = MakeSyntheticTriplet(options, 3);
  TripletView& view = triplet.view;
  constexpr double kShift = 0.35;
  const RigidTransform& i_from_j = view.geometry.cami_from_camj;
  const RigidTransform& k_from_j = view.geometry.camk_from_camj;
  for (int n = 0; n < 15; ++n) {
    // Seen in i and j as it is, in k as if its baseline were longer.
    TripletPoint& point = view.points[n];
    const double depth = 3 + 0.05 * n;
    const Vec3 x = depth * point.in_j;
    const Vec3 in_i = i_from_j * x;
    const Vec3 in_k =
        k_from_j.rotation * x +
        std::exp(triplet.true_log_ratio + kShift) * k_from_j.translation;
    point.in_i = in_i / in_i.z();
    point.in_k = in_k / in_k.z();
  }
  const RatioProfile profile = Profile(view);
  EXPECT_NEAR(profile.mode.log_ratio, triplet.true_log_ratio, 0.02);
  ASSERT_TRUE(profile.second_mode.has_value());
  EXPECT_NEAR(profile.second_mode->log_ratio, triplet.true_log_ratio + kShift,
              0.02);
  EXPECT_LT(profile.second_mode->nfa.log10_nfa, -5);
  // The estimator finds it too.
  ASSERT_TRUE(profile.ratio.second_mode.has_value());
  EXPECT_NEAR(profile.ratio.second_mode->log_ratio,
              triplet.true_log_ratio + kShift, 0.02);
  EXPECT_LT(profile.ratio.second_mode->log10_nfa, -5);
}

TEST(RatioProfile, FeaturesThatAgreeHaveNoSecondMode) {
  SyntheticTripletOptions options = Mixed();
  options.wrong_share = 0;
  options.num_lines_ij = options.num_lines_jk = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RatioProfile profile =
        Profile(MakeSyntheticTriplet(options, seed).view);
    EXPECT_FALSE(profile.ratio.second_mode.has_value());
  }
}

TEST(RatioProfile, IsEmptyWithoutCandidates) {
  const RatioProfile profile = Profile(MakeSyntheticTriplet({}, 1).view);
  EXPECT_TRUE(profile.nodes.empty());
  EXPECT_FALSE(profile.second_mode.has_value());
}

TEST(RatioProfile, BadInputIsAnError) {
  SyntheticTriplet triplet = MakeSyntheticTriplet(Mixed(), 1);
  triplet.view.geometry.focal_i_px = 0;
  EXPECT_FALSE(ProfileRatio(triplet.view, {}).has_value());
}

}  // namespace
}  // namespace lowlap
