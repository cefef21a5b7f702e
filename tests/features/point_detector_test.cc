#include "lowlap/features/internal/points/point_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <opencv2/core.hpp>

#include "lowlap/geometry/types.h"
#include "support/matchers.h"
#include "support/random_vectors.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::BlobTexture;
using testing::IsError;
using testing::IsOk;
using testing::Render;
using testing::Turned;
using testing::Uniform;

struct Blobs {
  std::vector<Vec2> centers;
  std::vector<double> sigmas;

  double operator()(const Vec2& p) const {
    double value = 60;
    for (std::size_t i = 0; i < centers.size(); ++i) {
      value += 150 * std::exp(-0.5 * (p - centers[i]).squaredNorm() /
                              (sigmas[i] * sigmas[i]));
    }
    return value;
  }
};

// Far apart, at every fraction of a pixel.
Blobs MakeBlobs() {
  Blobs blobs;
  Random random(7);
  for (int i = 0; i < 16; ++i) {
    blobs.centers.push_back(Vec2(40 + 60 * (i % 4), 40 + 60 * (i / 4)) +
                            testing::UniformVec2(random, {0, 0}, {1, 1}));
    blobs.sigmas.push_back(2.0 + 0.2 * i);
  }
  return blobs;
}

std::vector<Vec2> NearestKeypointErrors(const Blobs& blobs,
                                        const PointFeatures& features) {
  std::vector<Vec2> errors;
  for (const Vec2& center : blobs.centers) {
    Vec2 best = Vec2::Constant(1e3);
    for (const Keypoint& keypoint : features.keypoints) {
      const Vec2 error = keypoint.position_px - center;
      if (error.norm() < best.norm()) best = error;
    }
    errors.push_back(best);
  }
  return errors;
}

TEST(DetectPointsTest, FindsBlobsAtTheirSubPixelPlaceWithoutBias) {
  const Blobs blobs = MakeBlobs();
  const auto features = DetectPoints(Render(280, 280, blobs), {});
  ASSERT_THAT(features, IsOk());
  ASSERT_EQ(features->keypoints.size(), features->descriptors.size());
  Vec2 mean = Vec2::Zero();
  for (const Vec2& error : NearestKeypointErrors(blobs, *features)) {
    EXPECT_LT(error.norm(), 0.15);
    mean += error / 16;
  }
  // Uncorrected, the doubling of the image shifts everything by 0.25 px.
  EXPECT_LT(mean.norm(), 0.04);
}

TEST(DetectPointsTest, NoiseMovesBlobsLittle) {
  const Blobs blobs = MakeBlobs();
  const auto features = DetectPoints(Render(280, 280, blobs, 3.0), {});
  ASSERT_THAT(features, IsOk());
  for (const Vec2& error : NearestKeypointErrors(blobs, *features)) {
    EXPECT_LT(error.norm(), 0.5);
  }
}

TEST(DetectPointsTest, ScaleIsThatOfTheBlob) {
  Blobs blob;
  blob.centers = {Vec2(64.3, 63.8)};
  blob.sigmas = {4.0};
  const auto features = DetectPoints(Render(128, 128, blob), {});
  ASSERT_THAT(features, IsOk());
  ASSERT_FALSE(features->keypoints.empty());
  // The difference of Gaussians peaks a little below the blob's own scale.
  EXPECT_NEAR(features->keypoints[0].scale_px, 4.0, 0.8);
}

TEST(DetectPointsTest, ATurnedImageHasTurnedKeypointsWithTheSameDescriptors) {
  const GrayImage image = Render(160, 120, BlobTexture(3, 120, 160));
  const GrayImage turned = Turned(image);
  const auto a = DetectPoints(image, {});
  const auto b = DetectPoints(turned, {});
  ASSERT_THAT(a, IsOk());
  ASSERT_THAT(b, IsOk());
  ASSERT_GT(a->keypoints.size(), 50u);
  int found = 0;
  for (std::size_t i = 0; i < a->keypoints.size(); ++i) {
    const Keypoint& k = a->keypoints[i];
    const Vec2 expected(image.height - 1 - k.position_px.y(),
                        k.position_px.x());
    for (std::size_t j = 0; j < b->keypoints.size(); ++j) {
      const Keypoint& other = b->keypoints[j];
      const double turn =
          std::remainder(other.angle_rad - k.angle_rad - kPi / 2, 2 * kPi);
      if ((other.position_px - expected).norm() > 0.3 || std::abs(turn) > 0.1) {
        continue;
      }
      int distance2 = 0;
      for (int d = 0; d < 128; ++d) {
        const int e = a->descriptors[i][d] - b->descriptors[j][d];
        distance2 += e * e;
      }
      // Descriptors have length 512. Octaves are halved by leaving out every
      // second pixel, which is not symmetric: the match is close, not exact.
      if (distance2 < 100 * 100) {
        ++found;
        break;
      }
    }
  }
  EXPECT_GT(found, 0.7 * static_cast<double>(a->keypoints.size()));
}

TEST(DetectPointsTest, DescriptorsHaveLength512) {
  const auto features =
      DetectPoints(Render(160, 120, BlobTexture(3, 120, 160)), {});
  ASSERT_THAT(features, IsOk());
  for (const PointDescriptor& descriptor : features->descriptors) {
    double norm2 = 0;
    for (const int value : descriptor) norm2 += value * value;
    EXPECT_NEAR(std::sqrt(norm2), 512, 15);
  }
}

TEST(DetectPointsTest, SelectionKeepsTheStrongestAndStarvesNoCorner) {
  // Strong texture on the left, weak texture on the right.
  const BlobTexture texture(5, 700, 300);
  const GrayImage image = Render(300, 300, [&](const Vec2& p) {
    const double contrast = p.x() < 150 ? 1.0 : 0.2;
    return 128 + contrast * (texture(p) - 128);
  });
  const auto all = DetectPoints(image, {});
  PointOptions few;
  few.max_points = 100;
  const auto selected = DetectPoints(image, few);
  ASSERT_THAT(all, IsOk());
  ASSERT_THAT(selected, IsOk());
  ASSERT_GT(all->keypoints.size(), 200u);
  EXPECT_EQ(selected->keypoints.size(), 100u);
  const auto on_the_right =
      std::count_if(selected->keypoints.begin(), selected->keypoints.end(),
                    [](const Keypoint& k) { return k.position_px.x() > 155; });
  EXPECT_GE(on_the_right, 8);
  EXPECT_LE(on_the_right, 50);
}

TEST(DetectPointsTest, SortedAndTheSameForAnyNumberOfOpenCvThreads) {
  const GrayImage image = Render(200, 150, BlobTexture(11, 200, 200));
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const auto one = DetectPoints(image, {});
  cv::setNumThreads(2);
  const auto two = DetectPoints(image, {});
  EXPECT_EQ(cv::getNumThreads(), 2) << "the host's setting must come back";
  cv::setNumThreads(before);
  ASSERT_THAT(one, IsOk());
  ASSERT_THAT(two, IsOk());
  EXPECT_EQ(one->descriptors, two->descriptors);
  ASSERT_EQ(one->keypoints.size(), two->keypoints.size());
  for (std::size_t i = 0; i < one->keypoints.size(); ++i) {
    EXPECT_EQ(one->keypoints[i].position_px, two->keypoints[i].position_px);
    if (i == 0) continue;
    EXPECT_LE(one->keypoints[i - 1].position_px.y(),
              one->keypoints[i].position_px.y());
  }
}

TEST(DetectPointsTest, ImagesWithoutTextureHaveNoKeypoints) {
  for (const GrayImage& image :
       {Uniform(100, 80, 255), Uniform(100, 80, 0), Uniform(1, 1, 128),
        Uniform(1, 100, 128), Uniform(15, 15, 128), Uniform(16, 16, 128)}) {
    const auto features = DetectPoints(image, {});
    ASSERT_THAT(features, IsOk());
    EXPECT_TRUE(features->keypoints.empty());
  }
}

TEST(DetectPointsTest, RejectsAnEmptyImageAndBadOptions) {
  EXPECT_THAT(DetectPoints(GrayImage{}, {}),
              IsError(ErrorCode::kInvalidArgument, "0 x 0"));
  PointOptions options;
  options.max_points = 0;
  EXPECT_THAT(DetectPoints(Uniform(50, 50, 1), options),
              IsError(ErrorCode::kInvalidArgument, "max_points"));
  options = {};
  options.contrast_threshold = -1;
  EXPECT_THAT(options.Validate(),
              IsError(ErrorCode::kInvalidArgument, "contrast_threshold"));
  options = {};
  options.edge_threshold = 0.5;
  EXPECT_THAT(options.Validate(),
              IsError(ErrorCode::kInvalidArgument, "edge_threshold"));
}

// White where `inside` says so.
template <class Inside>
GrayImage Draw(const Inside& inside) {
  GrayImage image;
  image.width = image.height = 101;
  for (int y = 0; y < 101; ++y) {
    for (int x = 0; x < 101; ++x) {
      image.pixels.push_back(inside(x - 50, y - 50) ? 220 : 30);
    }
  }
  return image;
}

TEST(LocalizationCovariance, IsRoundAtABlob) {
  const GrayImage image = Draw([](int x, int y) { return x * x + y * y < 30; });
  const Mat2 covariance = LocalizationCovariance(image, Vec2(50, 50), 4);
  EXPECT_NEAR(covariance(0, 0), 1, 0.1);
  EXPECT_NEAR(covariance(1, 1), 1, 0.1);
}

TEST(LocalizationCovariance, IsLongAlongAnEdge) {
  for (const double angle : {0.0, 0.4, 1.1}) {
    const Vec2 normal(std::cos(angle), std::sin(angle));
    const GrayImage image =
        Draw([&](int x, int y) { return normal.dot(Vec2(x, y)) > 0; });
    const Mat2 covariance = LocalizationCovariance(image, Vec2(50, 50), 3);
    const Eigen::SelfAdjointEigenSolver<Mat2> solver(covariance);
    EXPECT_NEAR(solver.eigenvalues()(0), 1, 1e-9);
    EXPECT_GT(solver.eigenvalues()(1), 10);
    EXPECT_LE(solver.eigenvalues()(1), 100 + 1e-9);
    EXPECT_LT(std::abs(solver.eigenvectors().col(1).dot(normal)), 0.2);
  }
}

TEST(LocalizationCovariance, IsTheIdentityWhereNothingIsSeen) {
  const GrayImage image = Draw([](int, int) { return false; });
  EXPECT_EQ(LocalizationCovariance(image, Vec2(50, 50), 3), Mat2::Identity());
}

TEST(LocalizationCovariance, IsDefinedAtTheBorder) {
  const GrayImage image = Draw([](int x, int) { return x > 0; });
  for (const Vec2& corner : {Vec2(0, 0), Vec2(100, 100)}) {
    EXPECT_TRUE(LocalizationCovariance(image, corner, 20).allFinite());
  }
}

}  // namespace
}  // namespace lowlap
