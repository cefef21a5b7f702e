#include "lowlap/features/internal/points/tilted_image.h"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "support/matchers.h"
#include "support/random_vectors.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::IsOk;

constexpr int kWidth = 300, kHeight = 200;

/// Blobs far apart, which are round in the tilted image.
struct Blobs {
  std::vector<Vec2> centers;
  std::vector<double> sigmas;
  Mat2 tilted_from_image;

  double operator()(const Vec2& p) const {
    double value = 60;
    for (std::size_t n = 0; n < centers.size(); ++n) {
      value +=
          150 *
          std::exp(-0.5 * (tilted_from_image * (p - centers[n])).squaredNorm() /
                   (sigmas[n] * sigmas[n]));
    }
    return value;
  }
};

class TiltImageTest
    : public ::testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(TiltImageTest, PointsOfItLieInTheImageWhereTheyAre) {
  const auto [scale, tilt, turn_rad] = GetParam();
  const auto flat =
      TiltImage(testing::Uniform(kWidth, kHeight, 0), scale, tilt, turn_rad);
  ASSERT_THAT(flat, IsOk());
  Blobs blobs;
  blobs.tilted_from_image = flat->linear;
  Random random(3);
  for (int n = 0; n < 6; ++n) {
    blobs.centers.push_back(Vec2(50 + 100 * (n % 3), 50 + 100 * (n / 3)) +
                            testing::UniformVec2(random, {0, 0}, {1, 1}));
    blobs.sigmas.push_back(2 + 0.2 * n);
  }
  const auto tilted =
      TiltImage(testing::Render(kWidth, kHeight, blobs), scale, tilt, turn_rad);
  ASSERT_THAT(tilted, IsOk());
  const auto found = DetectPoints(tilted->image, {});
  ASSERT_THAT(found, IsOk());
  Vec2 mean = Vec2::Zero();
  int count = 0;
  for (const Vec2& center : blobs.centers) {
    Vec2 best = Vec2::Constant(1e3);
    for (const Keypoint& keypoint : found->keypoints) {
      const Vec2 error = Untilted(keypoint, *tilted).position_px - center;
      if (error.norm() < best.norm()) best = error;
    }
    if (best.norm() > 10) continue;  // SIFT misses some
    ++count;
    EXPECT_LT(best.norm(), 0.15 * tilt / scale);
    mean += best;
  }
  ASSERT_GE(count, 4);
  EXPECT_LT(mean.norm() / count, 0.05 * tilt / scale);
}

INSTANTIATE_TEST_SUITE_P(
    Tilts, TiltImageTest,
    ::testing::Values(std::tuple(1.0, 1.0, 0.0), std::tuple(1.0, 2.0, 0.0),
                      std::tuple(1.0, 1.4, 0.7), std::tuple(1.0, 3.0, 2.0),
                      std::tuple(0.6, 1.0, 0.0), std::tuple(0.6, 2.0, 1.1)));

TEST(TiltImageTest, HoldsTheWholeImageAndIsNoLargerThanThat) {
  const auto tilted =
      TiltImage(testing::Uniform(kWidth, kHeight, 90), 0.8, 2, 0.6);
  ASSERT_THAT(tilted, IsOk());
  Vec2 low = Vec2::Constant(1e3), high = -low;
  for (const double x : {0, kWidth - 1}) {
    for (const double y : {0, kHeight - 1}) {
      const Vec2 corner = tilted->linear * Vec2(x, y) + tilted->offset_px;
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  EXPECT_NEAR(low.norm(), 0, 1e-9);
  EXPECT_EQ(tilted->image.width, static_cast<int>(high.x()) + 1);
  EXPECT_EQ(tilted->image.height, static_cast<int>(high.y()) + 1);
  for (const std::uint8_t pixel : tilted->image.pixels) EXPECT_EQ(pixel, 90);
}

TEST(UntiltedTest, IsLessCertainAndLongerAlongTheTilt) {
  TiltedImage tilted;
  tilted.linear = Vec2(0.25, 1).asDiagonal();
  Keypoint keypoint;
  keypoint.scale_px = 2;
  keypoint.angle_rad = RadFromDeg(315);
  const Keypoint untilted = Untilted(keypoint, tilted);
  EXPECT_TRUE(untilted.covariance.isApprox(Mat2(Vec2(16, 1).asDiagonal())));
  EXPECT_DOUBLE_EQ(untilted.scale_px, 4);
  EXPECT_NEAR(untilted.angle_rad, std::atan2(-1, 4) + 2 * kPi, 1e-12);
}

}  // namespace
}  // namespace lowlap
