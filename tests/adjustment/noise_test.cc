#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lowlap/adjustment/internal/rounds/pairs.h"
#include "lowlap/adjustment/internal/structure/line_track.h"
#include "lowlap/adjustment/internal/structure/noise_scale.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "test_scene.h"

namespace lowlap {
namespace {

constexpr double kArea = 1200 * 800;
constexpr double kDiagonal = 1442.2;

TEST(NoiseTest, ThresholdSeparatesNoiseFromOutliers) {
  Random random(1);
  for (const double stddev : {0.3, 1.0, 5.0}) {
    std::vector<double> errors;
    for (int n = 0; n < 2000; ++n) {
      errors.push_back(
          std::hypot(random.Gaussian(stddev), random.Gaussian(stddev)));
    }
    for (int n = 0; n < 400; ++n) errors.push_back(random.Uniform(0, 400));
    const NoiseScale noise = EstimateNoise(
        errors, BackgroundLaw::PointToPoint(kArea), kMedianOfNorm<2>, {});
    EXPECT_NEAR(noise.stddev_px, stddev, 0.1 * stddev);
    EXPECT_GT(noise.threshold_px, 2 * stddev);
    EXPECT_LT(noise.threshold_px, 5 * stddev);
  }
}

TEST(NoiseTest, ExactDataKeepsTheLowerBound) {
  const std::vector<double> errors(100, 1e-12);
  NoiseBounds bounds;
  const NoiseScale noise =
      EstimateNoise(errors, BackgroundLaw::PointToLine(kArea, kDiagonal),
                    kMedianOfNorm<1>, bounds);
  EXPECT_GE(noise.threshold_px, bounds.min_threshold_px);
  EXPECT_LT(noise.threshold_px, 1.1 * bounds.min_threshold_px);
  EXPECT_EQ(noise.stddev_px, bounds.min_threshold_px / 20);
}

TEST(NoiseTest, TooFewOrMeaninglessErrorsFallBack) {
  NoiseBounds bounds;
  bounds.fallback = {0.7, 2.1};
  const BackgroundLaw law = BackgroundLaw::PointToPoint(kArea);
  for (const std::vector<double>& errors :
       {std::vector<double>{}, std::vector<double>{0.1, 0.2},
        std::vector<double>(100, std::numeric_limits<double>::infinity())}) {
    const NoiseScale noise =
        EstimateNoise(errors, law, kMedianOfNorm<2>, bounds);
    EXPECT_EQ(noise.stddev_px, 0.7);
    EXPECT_EQ(noise.threshold_px, 2.1);
  }
}

// Gaps of truly coplanar lines with 1 px of noise are 1 px in the mean square;
// those of lines on different walls are not.
TEST(NoiseTest, PairGapsAreInPixelsOfSegmentNoise) {
  for (const bool frontal : {false, true}) {
    SCOPED_TRACE(frontal ? "frontal wall" : "all walls");
    test::TestSceneOptions options;
    options.num_lines = 400;
    options.max_line_views = 3;
    options.noise_px = 0.5;
    options.frontal_wall_only = frontal;
    const test::TestScene test = MakeTestScene(options);
    const CameraSet cameras(test.scene);
    std::vector<LineTrackState> lines = LoadLines(test.scene, cameras, false);
    TriangulationLimits limits;
    limits.threshold_px = 3;
    limits.noise_px = 0.5;
    limits.max_relative_depth_stddev = 0.05;
    double squares = 0;
    int count = 0, wrong_count = 0, wrong_large = 0;
    std::vector<std::pair<int, LineEstimate>> estimates;
    for (LineTrackState& line : lines) {
      Triangulate(cameras, limits, &line);
      if (!line.IsLandmark()) continue;
      const auto estimate = EstimateFromSegments(cameras, line);
      ASSERT_TRUE(estimate.has_value());
      estimates.emplace_back(test.wall_of_line.at(line.id), *estimate);
    }
    ASSERT_GT(estimates.size(), 200u);
    for (std::size_t a = 0; a < estimates.size(); ++a) {
      for (std::size_t b = a + 1; b < a + 20 && b < estimates.size(); ++b) {
        const LineEstimate &first = estimates[a].second,
                           &second = estimates[b].second;
        if (first.direction.cross(second.direction).norm() < 0.3) continue;
        const double gap = ComputePairGap(first, second).gap_px;
        if (estimates[a].first == estimates[b].first) {
          squares += gap * gap;
          ++count;
        } else {
          ++wrong_count;
          wrong_large += gap > 3 ? 1 : 0;
        }
      }
    }
    ASSERT_GT(count, 300);
    EXPECT_NEAR(std::sqrt(squares / count), 0.5, 0.1);
    if (!frontal) {
      EXPECT_GT(wrong_large, 0.6 * wrong_count);
    }
  }
}

}  // namespace
}  // namespace lowlap
