#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "lowlap/scale/scale_estimator.h"
#include "scale/synthetic_planes.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticPlanes;
using testing::SyntheticPlanes;
using testing::SyntheticPlanesOptions;

ScaleRatio EstimateOn(const SyntheticPlanes& scene) {
  return AContrarioScaleEstimator(scene.Kinds()).Estimate(scene.View()).value();
}

TEST(RatioFromPlanes, IsFoundWithoutAnySharedFeature) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  constexpr int kTriplets = 60;
  int meaningful = 0, within = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, seed);
    const ScaleRatio ratio = EstimateOn(scene);
    if (ratio.verdict != RatioVerdict::kMeaningful) continue;
    ++meaningful;
    const double error = ratio.log_ratio - scene.true_log_ratio;
    EXPECT_LT(std::abs(error), 0.05) << "seed " << seed;
    within += std::abs(error) < 2 * ratio.log_ratio_stddev;
    const KindSupport& kind = ratio.kinds.front();
    EXPECT_EQ(kind.candidates, static_cast<int>(scene.Points().size()));
    EXPECT_GT(kind.inliers, 0);
    EXPECT_LT(kind.log10_nfa, 0);
  }
  EXPECT_GT(meaningful, 0.9 * kTriplets);
  EXPECT_GT(within, 0.85 * meaningful);
}

// Beside those of the triplet, up to three of another one.
class WithWrongPlanes : public EvidenceKind {
 public:
  WithWrongPlanes(EvidenceKinds right, EvidenceKinds wrong)
      : kinds_{right.front(), wrong.front()} {}
  std::string Name() const override { return "mixed"; }
  std::unique_ptr<Evidence> Gather(const TripletView& view) const override {
    return std::make_unique<Mixed>(kinds_[0]->Gather(view),
                                   kinds_[1]->Gather(view));
  }

 private:
  class Mixed : public Evidence {
   public:
    Mixed(std::shared_ptr<const Evidence> right,
          std::shared_ptr<const Evidence> wrong)
        : parts_{right, wrong}, num_right_(right->size()) {
      for (const RatioCandidate& ratio : right->ratios()) AddCandidate(ratio);
      for (int n = 0; n < std::min(3, wrong->size()); ++n) {
        AddCandidate(wrong->ratios()[n]);
      }
    }
    float ErrorOf(double tau, int n) const override {
      return n < num_right_ ? parts_[0]->ErrorOf(tau, n)
                            : parts_[1]->ErrorOf(tau, n - num_right_);
    }
    double NumTests() const override { return size(); }

   private:
    std::shared_ptr<const Evidence> parts_[2];
    int num_right_;
  };
  EvidenceKinds kinds_;
};

TEST(RatioFromPlanes, SurvivesSomeWrongPlanes) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  constexpr int kTriplets = 40;
  int right = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, seed);
    options.unrelated_walls = true;
    const SyntheticPlanes wrong = MakeSyntheticPlanes(options, seed);
    options.unrelated_walls = false;
    const ScaleRatio ratio =
        AContrarioScaleEstimator(
            {std::make_shared<WithWrongPlanes>(scene.Kinds(), wrong.Kinds())})
            .Estimate(scene.View())
            .value();
    right += ratio.verdict == RatioVerdict::kMeaningful &&
             std::abs(ratio.log_ratio - scene.true_log_ratio) < 0.05;
  }
  EXPECT_GT(right, 0.8 * kTriplets);
}

TEST(RatioFromPlanes, IsSeldomMeaningfulForUnrelatedPlanes) {
  SyntheticPlanesOptions options;
  options.unrelated_walls = true;
  options.noise_px = 1;
  constexpr int kTriplets = 600;
  int meaningful = 0, with_points = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticPlanes scene = MakeSyntheticPlanes(options, seed);
    const ScaleRatio ratio = EstimateOn(scene);
    with_points += ratio.kinds.front().candidates > 0;
    meaningful += ratio.verdict == RatioVerdict::kMeaningful;
  }
  EXPECT_LE(meaningful, kTriplets / 100);
  EXPECT_GT(with_points, kTriplets / 2);
}

TEST(RatioFromPlanes, IsInvertedWhenTheEndsAreSwapped) {
  SyntheticPlanesOptions options;
  options.noise_px = 0.5;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 3);
  TripletView swapped = scene.View();
  swapped.geometry = swapped.geometry.Swapped();
  const EvidenceKinds kinds = {std::make_shared<PlanePointsKind>(
      PlanesByPair{{{1, 0}, scene.PlanesJk()}, {{1, 2}, scene.PlanesIj()}})};
  const ScaleRatio a = EstimateOn(scene);
  const ScaleRatio b =
      AContrarioScaleEstimator(kinds).Estimate(swapped).value();
  EXPECT_NEAR(a.log_ratio, -b.log_ratio, 1e-4);
  EXPECT_NEAR(a.log10_nfa, b.log10_nfa, 0.05);
}

}  // namespace
}  // namespace lowlap
