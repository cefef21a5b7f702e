#include "lowlap/scale/evidence/internal/line_in_middle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/geometry/internal/rotation.h"
#include "scale/synthetic_room.h"

namespace lowlap {
namespace {

RigidTransform Neighbor() {
  return RigidTransform::FromRotationAndCenter(
      RotationFromAngleAxis({0.05, -0.2, 0.1}), Vec3(0.8, 0.6, 0));
}

NormalizedSegment Seen(const Vec3& a, const Vec3& b) {
  return testing::MakeSegment(a / a.z(), b / b.z());
}

const Vec3 kA(-0.5, 0.3, 4), kB(0.7, 0.9, 5);

TEST(DepthOnPlane, IsTheDepthOfThePointOfTheLine) {
  const RigidTransform n_from_j = Neighbor();
  const Vec3 normal = Seen(n_from_j * kA, n_from_j * kB).normal;
  for (const double share : {0.0, 0.3, 1.0, 1.5}) {
    const Vec3 x = kA + share * (kB - kA);
    EXPECT_NEAR(DepthOnPlane(n_from_j, normal, x / x.z()), x.z(), 1e-9);
  }
}

TEST(LineInMiddle, PassesThroughThePointsSeen) {
  const RigidTransform n_from_j = Neighbor();
  CandidateStatus status;
  const auto line = LineInMiddle(n_from_j, Seen(kA, kB),
                                 Seen(n_from_j * kA, n_from_j * kB), &status);
  EXPECT_EQ(status, CandidateStatus::kValid);
  ASSERT_TRUE(line.has_value());
  for (const Vec3& x : {kA, kB}) {
    EXPECT_LT((line->ClosestPointTo(x) - x).norm(), 1e-9);
  }
}

TEST(LineInMiddle, IsNegativeBehindTheCamera) {
  const RigidTransform n_from_j = Neighbor();
  RigidTransform reversed = n_from_j;
  reversed.translation *= -1;
  CandidateStatus status;
  EXPECT_FALSE(LineInMiddle(reversed, Seen(kA, kB),
                            Seen(n_from_j * kA, n_from_j * kB), &status));
  EXPECT_EQ(status, CandidateStatus::kNegativeDepth);
}

TEST(LineInMiddle, IsDegenerateInAnEpipolarPlaneOrWithoutASegment) {
  const RigidTransform n_from_j = Neighbor();
  const Vec3 in_plane = kA + 0.7 * n_from_j.Center();
  CandidateStatus status;
  EXPECT_FALSE(LineInMiddle(n_from_j, Seen(kA, in_plane),
                            Seen(n_from_j * kA, n_from_j * in_plane), &status));
  EXPECT_EQ(status, CandidateStatus::kDegenerate);
  EXPECT_FALSE(LineInMiddle(n_from_j, NormalizedSegment(),
                            Seen(n_from_j * kA, n_from_j * kB), &status));
  EXPECT_EQ(status, CandidateStatus::kDegenerate);
}

}  // namespace
}  // namespace lowlap
