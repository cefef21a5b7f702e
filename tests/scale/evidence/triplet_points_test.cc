#include "lowlap/scale/evidence/internal/triplet_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scale/rig.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticTriplet;
using testing::Rig;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

TEST(TripletPointSolver, ExactWithoutNoise) {
  SyntheticTripletOptions options;
  options.num_points = 200;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 1);
  for (const TripletPoint& point : triplet.view.points) {
    const RatioCandidate ratio =
        TripletPointSolver(triplet.view.geometry).Ratio(point);
    ASSERT_EQ(ratio.status, CandidateStatus::kValid);
    EXPECT_NEAR(ratio.log_ratio, triplet.true_log_ratio, 1e-9);
    EXPECT_GT(ratio.log_ratio_stddev, 0);
  }
}

TEST(TripletPointSolver, PointOnTheBaselineIsDegenerate) {
  Rig rig;
  rig.center_i = Vec3(0, 0, -1);  // the forward motion's baseline is the z axis
  rig.geometry.cami_from_camj = {Mat3::Identity(), -rig.center_i};
  EXPECT_EQ(TripletPointSolver(rig.geometry).Ratio(rig.Point({0, 0, 4})).status,
            CandidateStatus::kDegenerate);
  // On the line of the other baseline: visible, and without parallax in k.
  Rig other;
  other.center_k = Vec3(0.1, 0, 1);
  other.geometry.camk_from_camj = {Mat3::Identity(),
                                   -other.center_k.normalized()};
  EXPECT_EQ(TripletPointSolver(other.geometry)
                .Ratio(other.Point(4 * other.center_k))
                .status,
            CandidateStatus::kDegenerate);
}

TEST(TripletPointSolver, NegativeDepthIsToldApart) {
  const Rig rig;
  TripletPoint point = rig.Point({0.3, 0.2, 5});
  // The parallax of i reversed: the rays meet behind the cameras.
  std::swap(point.in_i, point.in_j);
  EXPECT_EQ(TripletPointSolver(rig.geometry).Ratio(point).status,
            CandidateStatus::kNegativeDepth);
}

}  // namespace
}  // namespace lowlap
