#include "lowlap/directions/internal/vanishing_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "two_view/line_scene.h"

namespace lowlap {
namespace {

using testing::LineSceneOptions;
using testing::MakeLineScene;

// Angle between lines, whatever the signs of their directions.
double LineAngleDeg(const Vec3& a, const Vec3& b) {
  return DegFromRad(std::min(AngleBetween(a, b), AngleBetween(a, -b)));
}

double NearestDeg(const std::vector<VanishingDirection>& found,
                  const Vec3& direction) {
  double nearest = 180;
  for (const VanishingDirection& f : found) {
    nearest = std::min(nearest, LineAngleDeg(f.direction, direction));
  }
  return nearest;
}

TEST(FindVanishingDirections, FindsEveryFamilyExactlyWithoutNoise) {
  const auto scene = MakeLineScene({}, 1);
  const auto found = FindVanishingDirections(scene.views.features1, {});
  ASSERT_EQ(found.size(), 3u);
  for (const Vec3& direction : scene.directions) {
    EXPECT_LT(NearestDeg(found, direction), 1e-6);
  }
  for (const VanishingDirection& f : found) {
    EXPECT_EQ(f.segments.size(), 12u);
    EXPECT_LT(f.log10_nfa, 0);
    EXPECT_LT((f.covariance * f.direction).norm(), 1e-12);
  }
}

TEST(FindVanishingDirections, FindsThemAmongClutterAndNoise) {
  LineSceneOptions options;
  options.num_clutter = 30;
  options.noise_px = 0.3;
  for (int seed = 0; seed < 5; ++seed) {
    const auto scene = MakeLineScene(options, 10 + seed);
    const auto found = FindVanishingDirections(scene.views.features1, {});
    for (const Vec3& direction : scene.directions) {
      EXPECT_LT(NearestDeg(found, direction), 1) << "seed " << seed;
    }
  }
}

TEST(FindVanishingDirections, FindsHardlyAnyInClutterAlone) {
  LineSceneOptions options;
  options.lines_per_family = 0;
  options.num_clutter = 150;
  std::size_t count = 0;
  for (int seed = 0; seed < 20; ++seed) {
    const auto scene = MakeLineScene(options, 100 + seed);
    count += FindVanishingDirections(scene.views.features1, {}).size();
  }
  // On average less than one in an image, by the definition of the NFA.
  EXPECT_LT(count, 10u);
}

// Lines of the same photograph with five times the pixels err by as many more.
TEST(FindVanishingDirections, LargeImagesMayErrByMorePixels) {
  LineSceneOptions options;
  options.num_clutter = 30;
  options.noise_px = 0.3;
  for (int seed = 0; seed < 5; ++seed) {
    NormalizedFeatures features =
        MakeLineScene(options, 10 + seed).views.features1;
    const auto small = FindVanishingDirections(features, {});
    features.focal_px *= 5;
    const auto large = FindVanishingDirections(features, {}, 5);
    ASSERT_EQ(large.size(), small.size());
    for (std::size_t n = 0; n < large.size(); ++n) {
      EXPECT_LT(LineAngleDeg(large[n].direction, small[n].direction), 0.1);
    }
  }
}

// The crossing of two segments that attracts others by chance, which the fit to
// them loses again, comes before one of the directions.
TEST(FindVanishingDirections, GoesOnAfterACandidateThatIsNone) {
  LineSceneOptions options;
  options.noise_px = 0.3;
  auto scene = MakeLineScene(options, 99);
  scene.views.features1.focal_px *= 20;
  EXPECT_EQ(FindVanishingDirections(scene.views.features1, {}).size(), 3u);
}

TEST(FindVanishingDirections, ReturnsNothingForNoSegments) {
  EXPECT_TRUE(FindVanishingDirections({}, {}).empty());
}

TEST(FitDirection, HasTheErrorThatItsCovarianceStates) {
  LineSceneOptions options;
  options.noise_px = 0.3;
  std::vector<int> family(12);
  for (int n = 0; n < 12; ++n) family[n] = n;
  VanishingOptions exact;
  exact.parallel_stddev_deg = 0.01;
  double sum = 0;
  constexpr int kTrials = 200;
  for (int seed = 0; seed < kTrials; ++seed) {
    const auto scene = MakeLineScene(options, 1000 + seed);
    const Vec3 truth = scene.directions[0];
    const auto fit = FitDirection(scene.views.features1, family, truth, exact);
    const auto basis = TangentBasis(fit.direction);
    const Vec2 error =
        basis.transpose() * (truth.dot(fit.direction) < 0 ? -truth : truth);
    const Mat2 covariance = basis.transpose() * fit.covariance * basis;
    sum += error.dot(covariance.inverse() * error);
  }
  // Two for two degrees of freedom; the reweighting may be cautious.
  EXPECT_GT(sum / kTrials, 0.6);
  EXPECT_LT(sum / kTrials, 3.5);
}

}  // namespace
}  // namespace lowlap
