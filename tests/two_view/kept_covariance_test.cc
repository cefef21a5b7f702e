#include "lowlap/two_view/internal/search/kept_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"
#include "tests/support/random_vectors.h"

namespace lowlap {
namespace {

RelativePose PoseWith(const Mat5& covariance, const Vec3& direction) {
  RelativePose pose;
  pose.direction = direction.normalized();
  pose.covariance = covariance;
  return pose;
}

Mat5 RandomCovariance(Random& random) {
  Mat5 root;
  for (int n = 0; n < root.size(); ++n) root(n) = random.Gaussian();
  return root * root.transpose();
}

double LeastEigenvalue(const Mat5& matrix) {
  return matrix.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
}

TEST(KeptCovariance, IsInNoDirectionLessThanEither) {
  Random random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Mat5 before = RandomCovariance(random);
    const Mat5 after = RandomCovariance(random);
    RelativePose refined = PoseWith(after, Vec3::UnitX());
    refined.log10_nfa = -1;
    const Mat5 kept = *KeptCovariance(PoseWith(before, Vec3::UnitX()), refined);
    EXPECT_GT(LeastEigenvalue(kept - before), -1e-9);
    EXPECT_GT(LeastEigenvalue(kept - after), -1e-9);
    // Nor more than it has to be: along some directions it is one of them.
    EXPECT_LT(LeastEigenvalue(kept - before), 1e-9);
    EXPECT_LT(LeastEigenvalue(kept - after), 1e-9);
  }
}

TEST(KeptCovariance, TurnsTheAxesWithTheDirection) {
  const Vec3 from = Vec3(0.1, -0.2, 1).normalized();
  const Vec3 axis = Vec3(1, 0.5, 0).normalized();
  const Vec3 to = RotationFromAngleAxis(0.2 * axis) * from;
  // Open along the great circle through both.
  const auto along = [&](const Vec3& direction) {
    Vec5 error = Vec5::Zero();
    error[1] = 0.5;
    error.tail<2>() = TangentBasis(direction).transpose() *
                      from.cross(to).cross(direction).normalized();
    return error;
  };
  const Mat5 little = 1e-6 * Mat5::Identity();
  const Mat5 kept = *KeptCovariance(
      PoseWith(along(from) * along(from).transpose() + little, from),
      PoseWith(little, to));
  EXPECT_LT((kept - along(to) * along(to).transpose() - little).norm(), 1e-9);
}

TEST(KeptCovariance, IsThatOfTheOnlyPoseThatHasOne) {
  const RelativePose with = PoseWith(2 * Mat5::Identity(), Vec3::UnitX());
  RelativePose without = with;
  without.covariance.reset();
  EXPECT_EQ(KeptCovariance(without, with), with.covariance);
  EXPECT_LT((*KeptCovariance(with, without) - *with.covariance).norm(), 1e-12);
  EXPECT_FALSE(KeptCovariance(without, without));
}

TEST(KeptCovariance, OfAPoseThatWasNotRefinedIsItsOwn) {
  Random random(2);
  const RelativePose pose =
      PoseWith(RandomCovariance(random), testing::GaussianVec3(random));
  EXPECT_EQ(KeptCovariance(pose, pose), pose.covariance);
}

TEST(KeptCovariance, OneWithoutFullRankTakesNothingAway) {
  const Mat5 before = Mat5::Identity();
  const RelativePose flat = PoseWith(Mat5::Zero(), Vec3::UnitX());
  const Mat5 kept = *KeptCovariance(PoseWith(before, Vec3::UnitX()), flat);
  EXPECT_LT((kept - before).norm(), 1e-12);
}

}  // namespace
}  // namespace lowlap
