#include "lowlap/scene/internal/align_poses.h"

#include <gtest/gtest.h>

#include "geometry/random_geometry.h"
#include "lowlap/geometry/internal/rotation.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::VectorNear;

std::vector<Pose> Moved(const Similarity& similarity, std::vector<Pose> poses) {
  for (Pose& pose : poses) {
    pose.rotation = pose.rotation * similarity.rotation.transpose();
    pose.center = similarity * pose.center;
  }
  return poses;
}

TEST(AlignPoses, RecoversTheSimilarity) {
  Random random(1);
  const Similarity truth{3, testing::RandomRotation(random),
                         testing::RandomVector(random)};
  for (const bool are_on_a_line : {false, true}) {
    std::vector<Pose> source(6);
    for (std::size_t n = 0; n < source.size(); ++n) {
      source[n].rotation = testing::RandomRotation(random);
      source[n].center =
          are_on_a_line ? Vec3(n, 2.0 * n, 0) : testing::RandomVector(random);
    }
    const auto found = AlignPoses(source, Moved(truth, source));
    ASSERT_THAT(found, IsOk());
    EXPECT_NEAR(found->scale, truth.scale, 1e-9);
    EXPECT_LT((found->rotation - truth.rotation).norm(), 1e-9);
    EXPECT_THAT(found->translation, VectorNear(truth.translation, 1e-9));
  }
}

TEST(AlignPoses, NoiseOfCentresOnALineTurnsNothing) {
  Random random(2);
  std::vector<Pose> source(8), target;
  for (std::size_t n = 0; n < source.size(); ++n) {
    source[n].rotation = testing::RandomRotation(random);
    source[n].center = Vec3(n, 0, 0);
  }
  target = source;
  for (std::vector<Pose>* poses : {&source, &target}) {
    for (Pose& pose : *poses) {
      pose.center += 1e-3 * testing::RandomVector(random);
    }
  }
  const auto found = AlignPoses(source, target);
  ASSERT_THAT(found, IsOk());
  EXPECT_LT(RotationAngleBetween(found->rotation, Mat3::Identity()), 2e-3);
}

TEST(AlignPoses, NeedsCamerasInDifferentPlaces) {
  std::vector<Pose> poses(3);
  EXPECT_THAT(AlignPoses(poses, poses),
              IsError(ErrorCode::kInsufficientData, "not all in one place"));
  EXPECT_THAT(AlignPoses({}, {}),
              IsError(ErrorCode::kInsufficientData, "not all in one place"));
  poses[1].center.x() = 1;
  EXPECT_THAT(
      AlignPoses(poses, std::vector<Pose>(poses.begin(), poses.end() - 1)),
      IsError(ErrorCode::kInvalidArgument, "as many sources"));
}

}  // namespace
}  // namespace lowlap
