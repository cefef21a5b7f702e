#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;
using testing::IsOk;

// No feature is seen by three views: only coplanar pairs carry the scale.
TestSceneOptions ChainOptions() {
  TestSceneOptions options;
  options.max_point_views = 2;
  options.max_line_views = 2;
  options.num_points = 400;
  options.num_lines = 400;
  options.pairs_per_triplet = 60;
  return options;
}

// Points and lines of three views determine everything; a third of the pairs
// is wrong.
TestSceneOptions GoodSceneOptions(std::uint64_t seed) {
  TestSceneOptions options = ChainOptions();
  options.max_point_views = 3;
  options.max_line_views = 3;
  options.noise_px = 0.5;
  options.wrong_pairs = 0.33;
  options.seed = seed;
  return options;
}

struct Outcome {
  double before = 0;
  double after = 0;
  AdjustmentSummary summary;
};

Outcome RunChain(const TestSceneOptions& options, double log_scale_stddev,
                 const AdjustmentOptions& adjustment) {
  TestScene test = MakeTestScene(options);
  test::PerturbPoses(0.002, 0, options.seed + 50, &test.scene);
  test::PerturbScales(log_scale_stddev, options.seed + 70, &test.scene);
  Outcome outcome;
  EXPECT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  outcome.before = ComparePoses(test.true_poses, test.scene).mean_center;
  const Result<AdjustmentSummary> summary =
      AdjustScene(&test.scene, adjustment, {});
  EXPECT_THAT(summary, IsOk());
  if (summary) outcome.summary = *summary;
  outcome.after = ComparePoses(test.true_poses, test.scene).mean_center;
  return outcome;
}

class CoplanarAdjustmentTest
    : public ::testing::TestWithParam<AdjustedCoplanarResidual> {
 protected:
  AdjustmentOptions Options() const {
    AdjustmentOptions options;
    options.coplanar_ties = CoplanarTies::kPairs;
    options.coplanar_residual = GetParam();
    return options;
  }
};

TEST_P(CoplanarAdjustmentTest, PairsBringTheScaleBackWithoutNoise) {
  const Outcome outcome = RunChain(ChainOptions(), 0.05, Options());
  EXPECT_GT(outcome.before, 0.02);
  EXPECT_LT(outcome.after, 0.0015);
  EXPECT_EQ(outcome.summary.components, 1u);
  EXPECT_GT(outcome.summary.coplanar.observations_used, 150u);
}

TEST_P(CoplanarAdjustmentTest, PairsImproveAChainWithNoiseAndWrongPairs) {
  double before = 0, after = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    TestSceneOptions options = ChainOptions();
    options.noise_px = 0.5;
    options.wrong_pairs = 0.2;
    options.seed = seed;
    const Outcome outcome = RunChain(options, 0.05, Options());
    before += outcome.before;
    after += outcome.after;
    EXPECT_LT(outcome.after, 0.03);
  }
  EXPECT_LT(after, 0.5 * before);
}

TEST_P(CoplanarAdjustmentTest, GoodScenesAreNotHarmed) {
  double with_pairs = 0, without = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const TestSceneOptions options = GoodSceneOptions(seed);
    AdjustmentOptions no_pairs;
    no_pairs.use_coplanar = false;
    with_pairs += RunChain(options, 0.02, Options()).after;
    without += RunChain(options, 0.02, no_pairs).after;
  }
  EXPECT_LT(with_pairs, 1.1 * without);
}

INSTANTIATE_TEST_SUITE_P(
    Residuals, CoplanarAdjustmentTest,
    ::testing::Values(AdjustedCoplanarResidual::kTransfer,
                      AdjustedCoplanarResidual::kImageDistance),
    [](const auto& parameter) {
      return parameter.param == AdjustedCoplanarResidual::kTransfer
                 ? "Transfer"
                 : "ImageDistance";
    });

TEST(CoplanarChainTest, WithoutPairsAChainKeepsItsScales) {
  // Nothing measures the scales: they must neither drift nor explode.
  AdjustmentOptions no_pairs;
  no_pairs.use_coplanar = false;
  const Outcome outcome = RunChain(ChainOptions(), 0.05, no_pairs);
  EXPECT_LT(outcome.after, 1.5 * outcome.before);
  EXPECT_EQ(outcome.summary.components, 1u);
}

TEST(CoplanarChainTest, LinesOnlyChain) {
  TestSceneOptions options = ChainOptions();
  options.num_points = 0;
  options.max_line_views = 3;
  options.noise_px = 0.3;
  const Outcome outcome = RunChain(options, 0.03, {});
  EXPECT_LT(outcome.after, 0.5 * outcome.before);
}

TEST(CoplanarChainTest, ReportedPairsAreThoseOfTheScene) {
  TestSceneOptions options = ChainOptions();
  options.noise_px = 0.5;
  options.wrong_pairs = 0.3;
  TestScene test = MakeTestScene(options);
  const Result<StructureSummary> structure =
      BuildStructure(&test.scene, {}, {});
  ASSERT_THAT(structure, IsOk());
  const Result<AdjustmentSummary> summary = AdjustScene(&test.scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  const KindAdjustment& pairs = summary->coplanar;
  EXPECT_EQ(pairs.observations_used + pairs.observations_surplus,
            test.scene.coplanar_pairs.size());
  EXPECT_EQ(pairs.observations_used + pairs.observations_surplus +
                pairs.observations_dropped,
            structure->coplanar_pairs);
  std::size_t wrong = 0;
  for (const CoplanarPair& pair : test.scene.coplanar_pairs) {
    wrong +=
        test.wall_of_line.at(pair.first) != test.wall_of_line.at(pair.second);
  }
  EXPECT_LT(wrong, 0.1 * test.scene.coplanar_pairs.size());
}

TEST(CoplanarChainTest, ALineIsHeldByAFewPairsOnly) {
  TestSceneOptions options = ChainOptions();
  options.num_lines = 100;
  options.pairs_per_triplet = 300;
  TestScene test = MakeTestScene(options);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  const std::size_t all = test.scene.coplanar_pairs.size();
  AdjustmentOptions adjustment;
  adjustment.coplanar_ties = CoplanarTies::kPairs;
  adjustment.max_pairs_per_line = 2;
  const Result<AdjustmentSummary> summary =
      AdjustScene(&test.scene, adjustment, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_LE(summary->coplanar.observations_used,
            test.scene.line_structure.size());
  EXPECT_GT(summary->coplanar.observations_surplus, 0.3 * all);
  // Those that were not needed are not lost.
  EXPECT_GT(test.scene.coplanar_pairs.size(), 0.9 * all);
}

// What lies on common walls carries the scale from pair to pair.
TEST(CoplanarTiesTest, PlanesHoldAChainBetterThanPairs) {
  double by_pairs = 0, by_planes = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    TestSceneOptions options = ChainOptions();
    options.noise_px = 0.5;
    options.seed = seed;
    AdjustmentOptions pairs;
    pairs.coplanar_ties = CoplanarTies::kPairs;
    by_pairs += RunChain(options, 0.05, pairs).after;
    AdjustmentOptions planes;
    planes.coplanar_ties = CoplanarTies::kPlanes;
    const Outcome outcome = RunChain(options, 0.05, planes);
    by_planes += outcome.after;
    EXPECT_GE(outcome.summary.planes, 3u);
    EXPECT_GT(outcome.summary.landmarks_on_planes, 400u);
    EXPECT_EQ(outcome.summary.coplanar.observations_used, 0u);
  }
  EXPECT_LT(by_planes, by_pairs);
}

TEST(CoplanarTiesTest, GoodScenesAreNotHarmed) {
  double with_planes = 0, without = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const TestSceneOptions options = GoodSceneOptions(seed);
    AdjustmentOptions planes;
    planes.coplanar_ties = CoplanarTies::kPlanes;
    AdjustmentOptions no_pairs;
    no_pairs.use_coplanar = false;
    with_planes += RunChain(options, 0.02, planes).after;
    without += RunChain(options, 0.02, no_pairs).after;
  }
  EXPECT_LT(with_planes, 1.05 * without);
}

// Points that are not used have no say, on planes either.
TEST(CoplanarTiesTest, PlanesOfLinesAlone) {
  TestSceneOptions options = ChainOptions();
  options.max_line_views = 3;
  options.noise_px = 0.3;
  AdjustmentOptions planes;
  planes.use_points = false;
  planes.coplanar_ties = CoplanarTies::kBoth;
  const Outcome outcome = RunChain(options, 0.03, planes);
  EXPECT_LT(outcome.after, 0.5 * outcome.before);
  EXPECT_GE(outcome.summary.planes, 3u);
  EXPECT_LE(outcome.summary.landmarks_on_planes,
            static_cast<std::size_t>(options.num_lines));
}

// Without rounds the observations are taken as they are, by planes too.
TEST(CoplanarTiesTest, PlanesLeaveObservationsAloneWithoutRounds) {
  TestSceneOptions options = ChainOptions();
  options.noise_px = 0.5;
  TestScene test = MakeTestScene(options);
  test::PerturbScales(0.05, 71, &test.scene);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  std::size_t taken = 0;
  for (auto& [id, landmark] : test.scene.structure) {
    // Off by what a round would drop.
    if (id.value() % 20 == 0) landmark.observations.front().pixel_px.x() += 60;
    taken += landmark.observations.size();
  }
  AdjustmentOptions planes;
  planes.max_outlier_rounds = 0;
  const Result<AdjustmentSummary> summary =
      AdjustScene(&test.scene, planes, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_GE(summary->planes, 3u);
  EXPECT_EQ(summary->points.observations_used, taken);
}

TEST(CoplanarTiesTest, GoByTheirNames) {
  EXPECT_EQ(*ParseCoplanarTies("pairs"), CoplanarTies::kPairs);
  EXPECT_EQ(*ParseCoplanarTies("planes"), CoplanarTies::kPlanes);
  EXPECT_EQ(*ParseCoplanarTies("both"), CoplanarTies::kBoth);
  EXPECT_FALSE(ParseCoplanarTies("walls"));
}

}  // namespace
}  // namespace lowlap
