#include "lowlap/scale/evidence/internal/coplanar_ratio.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/scale/evidence/internal/coplanar_candidates.h"
#include "scale/rig.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticTriplet;
using testing::Rig;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

std::vector<CoplanarPairCandidate> Pairs(const SyntheticTriplet& triplet) {
  return FindCoplanarCandidates(triplet.view.geometry, triplet.view.lines_ij,
                                triplet.view.lines_jk, 10)
      .pairs;
}

TEST(CoplanarRatio, ExactWithoutNoiseOnEveryWall) {
  SyntheticTripletOptions options;
  options.num_lines_ij = 60;
  options.num_lines_jk = 60;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 3);
  int right = 0;
  for (const CoplanarPairCandidate& pair : Pairs(triplet)) {
    if (triplet.wall_ij[pair.first] != triplet.wall_jk[pair.last]) continue;
    ++right;
    EXPECT_NEAR(pair.ratio.log_ratio, triplet.true_log_ratio, 1e-9);
  }
  EXPECT_GT(right, 200);
}

// The paper's longer form, with end points and the normal of the plane.
TEST(CoplanarRatio, EqualsTheFormOfThePaper) {
  SyntheticTripletOptions options;
  options.num_lines_ij = 40;
  options.num_lines_jk = 40;
  options.noise_px = 1;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 4);
  const TripletGeometry& g = triplet.view.geometry;
  for (const CoplanarPairCandidate& pair : Pairs(triplet)) {
    const MatchedLine& a = triplet.view.lines_ij[pair.first];
    const MatchedLine& b = triplet.view.lines_jk[pair.last];
    const Vec3 l_a1 = a.in_neighbor.segment.normal;
    const Vec3 l_b3 = b.in_neighbor.segment.normal;
    const Mat3& r21 = g.cami_from_camj.rotation;
    const Mat3& r23 = g.camk_from_camj.rotation;
    const Vec3 d_a = (r21.transpose() * l_a1).cross(a.in_middle.segment.normal);
    const Vec3 d_b = b.in_middle.segment.normal.cross(r23.transpose() * l_b3);
    const Vec3 n = d_a.cross(d_b);
    const Vec3 p_a = a.in_middle.segment.start, p_b = b.in_middle.segment.end;
    const double tau = l_b3.dot(r23 * p_b) * n.dot(p_a) *
                       l_a1.dot(g.cami_from_camj.translation) /
                       (l_a1.dot(r21 * p_a) * n.dot(p_b) *
                        l_b3.dot(g.camk_from_camj.translation));
    EXPECT_NEAR(pair.ratio.log_ratio, std::log(tau), 1e-8);
  }
}

TEST(CoplanarRatio, LineInAnEpipolarPlaneIsDegenerate) {
  const Rig rig;
  const MatchedLine a = rig.WithI({-1, 0.5, 5}, {1, 0.5, 5});
  const MatchedLine b = rig.WithK({0, -1, 5}, {0.5, 1, 5});
  EXPECT_EQ(CoplanarRatio(rig.geometry, a, b).status,
            CandidateStatus::kDegenerate);
}

TEST(CoplanarRatio, LinesParallelInTheImageAreDegenerate) {
  const Rig rig;  // a frontal wall keeps parallel lines parallel
  const MatchedLine a = rig.WithI({-1, -1, 5}, {-0.8, 1, 5});
  const MatchedLine b = rig.WithK({0, -1, 5}, {0.2, 1, 5});
  EXPECT_FALSE(
      CrossingInMiddle(a.in_middle.segment, b.in_middle.segment).has_value());
  EXPECT_EQ(CoplanarRatio(rig.geometry, a, b).status,
            CandidateStatus::kDegenerate);
}

TEST(CoplanarRatio, LinesCrossingAtTheirVanishingPointAreDegenerate) {
  const Rig rig;  // parallel in space, but not in the image
  const Vec3 d(0.3, 0.2, 1);
  const Vec3 p(-1, 0.5, 3), q(0.8, -0.5, 3);
  const MatchedLine a = rig.WithI(p, p + 2 * d);
  const MatchedLine b = rig.WithK(q, q + 2 * d);
  EXPECT_TRUE(
      CrossingInMiddle(a.in_middle.segment, b.in_middle.segment).has_value());
  EXPECT_EQ(CoplanarRatio(rig.geometry, a, b).status,
            CandidateStatus::kDegenerate);
}

TEST(CoplanarRatio, FrontalWallIsNotDegenerate) {
  const Rig rig;
  const MatchedLine a = rig.WithI({-1, -1, 5}, {0.5, 1, 5});
  const MatchedLine b = rig.WithK({0.5, -1, 5}, {-0.5, 0.8, 5});
  const RatioCandidate ratio = CoplanarRatio(rig.geometry, a, b);
  ASSERT_EQ(ratio.status, CandidateStatus::kValid);
  EXPECT_NEAR(ratio.log_ratio, rig.LogRatio(), 1e-12);
}

TEST(CoplanarRatio, NegativeDepthIsToldApart) {
  const Rig rig;
  MatchedLine a = rig.WithI({-1, -1, 5}, {0.5, 1, 5});
  const MatchedLine b = rig.WithK({0.5, -1, 5}, {-0.5, 0.8, 5});
  std::swap(a.in_middle, a.in_neighbor);
  EXPECT_EQ(CoplanarRatio(rig.geometry, a, b).status,
            CandidateStatus::kNegativeDepth);
}

}  // namespace
}  // namespace lowlap
