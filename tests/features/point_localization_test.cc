#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "lowlap/features/internal/points/point_detector.h"
#include "lowlap/geometry/types.h"

namespace lowlap {
namespace {

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
