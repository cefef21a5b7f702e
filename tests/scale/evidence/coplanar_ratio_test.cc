#include "lowlap/scale/evidence/internal/coplanar_ratio.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/scale/evidence/internal/coplanar_candidates.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"
#include "scale/rig.h"

namespace lowlap {
namespace {

using testing::MakeSegment;
using testing::MakeSyntheticTriplet;
using testing::NoisyTriplet;
using testing::Project;
using testing::Rig;
using testing::Scaled;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;
using testing::ToLine;

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

TEST(TransferResiduals, CarryTheCrossingToTheOuterViews) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  const double log_ratio = triplet.true_log_ratio - 0.1;
  const std::vector<CoplanarPairCandidate> pairs = Pairs(triplet);
  TransferResiduals residuals;
  for (const CoplanarPairCandidate& pair : pairs) {
    residuals.Add(g, triplet.view.lines_ij[pair.first],
                  triplet.view.lines_jk[pair.last], pair.ratio.log_ratio);
  }
  std::vector<float> errors_px(pairs.size());
  residuals.Evaluate(std::exp(log_ratio), residuals.size(), errors_px.data());
  const RigidTransform k_from_j = Scaled(g.camk_from_camj, std::exp(log_ratio));
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const MatchedLine& a = triplet.view.lines_ij[pairs[n].first];
    const MatchedLine& b = triplet.view.lines_jk[pairs[n].last];
    const Vec3 l_a = a.in_neighbor.segment.normal;
    const Vec3 l_b = b.in_neighbor.segment.normal;
    const Vec3 x = *CrossingInMiddle(a.in_middle.segment, b.in_middle.segment);
    const Vec3 on_a = DepthOnPlane(g.cami_from_camj, l_a, x) * x;
    // The depth on b at the scale of k.
    const double depth_b =
        std::exp(log_ratio) * DepthOnPlane(g.camk_from_camj, l_b, x);
    const Vec3 in_k = k_from_j * on_a, in_i = g.cami_from_camj * (depth_b * x);
    if (!(in_k.z() > 0) || !(in_i.z() > 0)) {
      EXPECT_GT(errors_px[n], 1e4);
      continue;
    }
    const double expected =
        450.0 * (ToLine(Project(in_k), l_b) + ToLine(Project(in_i), l_a));
    EXPECT_NEAR(errors_px[n], expected, 0.01 + 1e-4 * expected);
  }
}

// The residual of the paper is blind to the ratio where a wall faces camera j.
TEST(TransferResiduals, ReactOnAFrontalWallAsOnATiltedOne) {
  const Vec3 center_i(-1, 0, 0), center_k(1.5, 0, 0);
  TripletGeometry geometry;
  geometry.cami_from_camj = {Mat3::Identity(), -center_i};
  geometry.camk_from_camj = {Mat3::Identity(), -center_k.normalized()};
  geometry.focal_i_px = geometry.focal_j_px = geometry.focal_k_px = 1000;
  const auto errors = [&](double tilt) {
    const auto at = [&](double x, double y) {
      return Vec3(x, y, 5 + tilt * x);
    };
    const auto match = [&](const Vec3& center, const Vec3& p, const Vec3& q) {
      return MatchedLine{0,
                         {MakeSegment(p, q), 0.5},
                         {MakeSegment(p - center, q - center), 0.5}};
    };
    // The crossing is on the optical axis.
    const MatchedLine a = match(center_i, at(-0.5, -1), at(0.5, 1));
    const MatchedLine b = match(center_k, at(0.7, -1), at(-0.7, 1));
    const double log_ratio = std::log(1.5);
    TransferResiduals transfer;
    transfer.Add(geometry, a, b, log_ratio);
    float error_px = 0;
    transfer.Evaluate(1.5 * 1.05, 1, &error_px);
    return error_px;
  };
  EXPECT_GT(errors(0.0), 3);
  EXPECT_GT(errors(0.4), 3);
}

}  // namespace
}  // namespace lowlap
