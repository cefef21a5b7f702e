#include "lowlap/scale/evidence/internal/coplanar_lines.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

testing::SyntheticTriplet Triplet() {
  testing::SyntheticTripletOptions options;
  options.num_lines_ij = options.num_lines_jk = 40;
  options.noise_px = 0.5;
  return testing::MakeSyntheticTriplet(options, 1);
}

std::vector<int> All(const Evidence& evidence) {
  std::vector<int> candidates(evidence.size());
  std::iota(candidates.begin(), candidates.end(), 0);
  return candidates;
}

TEST(CoplanarLines, CountEveryLineOnceInNestedTiers) {
  const auto triplet = Triplet();
  const auto evidence = CoplanarLinesKind().Gather(triplet.view);
  const EvidenceUnits& units = evidence->units();
  EXPECT_EQ(units.num_sides, 2);
  ASSERT_EQ(units.num_tiers(), 2);
  EXPECT_GT(units.tiers[0].num_candidates, 0);
  EXPECT_GT(units.tiers[1].num_candidates, units.tiers[0].num_candidates);
  EXPECT_EQ(units.tiers[1].num_candidates, evidence->size());
  for (const int side : {0, 1}) {
    EXPECT_GE(units.tiers[1].num_units[side], units.tiers[0].num_units[side]);
    EXPECT_LE(units.tiers[1].num_units[side], 40);
  }
}

TEST(CoplanarLines, AreInliersAtTheirOwnRatio) {
  const auto triplet = Triplet();
  const auto evidence = CoplanarLinesKind().Gather(triplet.view);
  for (int n = 0; n < evidence->size(); ++n) {
    const double tau = std::exp(evidence->ratios()[n].log_ratio);
    EXPECT_LT(evidence->ErrorOf(tau, n), 0.01) << n;
  }
}

TEST(CoplanarLines, TellHowTheNoiseOfEitherLineMovesTheRatio) {
  const auto triplet = Triplet();
  const auto evidence = CoplanarLinesKind().Gather(triplet.view);
  const auto details = evidence->Details(triplet.view, All(*evidence));
  for (int n = 0; n < evidence->size(); ++n) {
    double variance = 0;
    for (const auto& side : details[n].moves) {
      for (const double move : side) variance += move * move;
    }
    EXPECT_TRUE(details[n].place.has_value());
    const double stddev = evidence->ratios()[n].log_ratio_stddev;
    EXPECT_NEAR(std::sqrt(variance), stddev, 1e-6 * stddev);
  }
}

TEST(CoplanarLines, AskForTheSameRatiosInTheSameGeometry) {
  const auto triplet = Triplet();
  const auto evidence = CoplanarLinesKind().Gather(triplet.view);
  const auto same =
      evidence->RatiosIn(triplet.view, triplet.view.geometry, All(*evidence));
  for (int n = 0; n < evidence->size(); ++n) {
    EXPECT_EQ(same[n].log_ratio, evidence->ratios()[n].log_ratio);
  }
}

TEST(CoplanarLines, OfNoLinesAreNone) {
  EXPECT_EQ(CoplanarLinesKind().Gather(TripletView())->size(), 0);
}

}  // namespace
}  // namespace lowlap
