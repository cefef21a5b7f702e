#include "lowlap/synthetic/internal/coplanar_truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/geometry/plucker_line.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/view_graph.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsOk;

SyntheticOptions NoOverlap() {
  SyntheticOptions options;
  options.trifocal_point_share = options.trifocal_line_share = 0;
  return options;
}

TEST(CoplanarCandidates, WrongShareAsAsked) {
  for (const double wanted : {0.3, 0.4, 0.7}) {
    for (const std::uint64_t seed : {0, 1, 2}) {
      SyntheticOptions options = NoOverlap();
      options.noise_px = 1;
      options.wrong_candidate_share = wanted;
      options.seed = seed;
      const Result<SyntheticScene> synthetic = Simulate(options);
      ASSERT_THAT(synthetic, IsOk());
      const CandidateCount count = CountCoplanarCandidates(*synthetic);
      EXPECT_GT(count.total, 5000);
      EXPECT_NEAR(count.WrongShare(), wanted, 0.01);
      // Enough right ones in every triplet.
      for (const ViewTriplet& triplet :
           FindTriplets(ViewGraph(synthetic->scene))) {
        const auto candidates = CoplanarCandidates(*synthetic, triplet);
        EXPECT_GT(std::count_if(candidates.begin(), candidates.end(),
                                [](const auto& c) { return c.is_coplanar; }),
                  50);
      }
    }
  }
}

TEST(CoplanarCandidates, LinesStayOnTheWallsUnlessAsked) {
  SyntheticOptions options;
  Result<SyntheticScene> synthetic = Simulate(options);
  ASSERT_THAT(synthetic, IsOk());
  for (const auto& [id, line] : synthetic->true_lines) {
    EXPECT_FALSE(line.planes.empty());
  }
  options.wrong_candidate_share = 0.5;
  synthetic = Simulate(options);
  ASSERT_THAT(synthetic, IsOk());
  for (const auto& [id, line] : synthetic->true_lines) {
    if (!line.planes.empty()) continue;
    for (const Vec4& plane : synthetic->planes) {
      const double off = std::max(std::abs(plane.dot(line.start.homogeneous())),
                                  std::abs(plane.dot(line.end.homogeneous())));
      EXPECT_GT(off, 1e-3);
    }
  }
}

// A line matched between the middle view and `other`, by its middle segment, in
// the middle camera at unit baseline.
std::map<FeatureIndex, PluckerLine> LinesInMiddle(const Scene& scene,
                                                  ViewId middle, ViewId other) {
  const RelativePose& edge = *scene.FindRelativePose(middle, other);
  const NormalizedFeatures here = NormalizeFeatures(
      scene.features.at(middle), *scene.FindIntrinsic(middle));
  const NormalizedFeatures there =
      NormalizeFeatures(scene.features.at(other), *scene.FindIntrinsic(other));
  std::map<FeatureIndex, PluckerLine> lines;
  for (const FeatureMatch& match : edge.line_inliers) {
    const bool forward = edge.views.first == middle;
    const FeatureIndex mine = forward ? match.first : match.second;
    const FeatureIndex its = forward ? match.second : match.first;
    const std::optional<PluckerLine> line = LineFromTwoViews(
        UnitTransform(edge, middle, other), here.segments[mine].normal,
        there.segments[its].normal, 1e-3);
    if (line) lines[mine] = *line;
  }
  return lines;
}

// The two lines meet at exactly one ratio of the baselines; for lines of one
// wall it is the true one. This ties tracks, poses, planes and the candidates'
// truth together.
class CandidatesOfKind : public ::testing::TestWithParam<SyntheticKind> {};

TEST_P(CandidatesOfKind, RightPairsGiveTheTrueRatioAndWrongOnesDoNot) {
  SyntheticOptions options = NoOverlap();
  options.kind = GetParam();
  options.wrong_candidate_share = 0.4;
  options.wrong_line_share = 0.1;
  const Result<SyntheticScene> synthetic = Simulate(options);
  ASSERT_THAT(synthetic, IsOk());
  const Scene& scene = synthetic->scene;
  int right = 0, wrong = 0, wrong_but_true = 0;
  for (const ViewTriplet& triplet : FindTriplets(ViewGraph(scene))) {
    const auto first = LinesInMiddle(scene, triplet.middle, triplet.first);
    const auto last = LinesInMiddle(scene, triplet.middle, triplet.last);
    const double truth = *synthetic->TrueLogRatio(triplet);
    for (const CoplanarCandidate& candidate :
         CoplanarCandidates(*synthetic, triplet)) {
      const auto a = first.find(candidate.line_in_first);
      const auto b = last.find(candidate.line_in_last);
      if (a == first.end() || b == last.end()) continue;
      // d_b . m_a + tau d_a . m_b = 0.
      const double constant = b->second.direction.dot(a->second.moment);
      const double slope = a->second.direction.dot(b->second.moment);
      if (std::abs(slope) < 1e-2 || std::abs(constant) < 1e-2) continue;
      const double tau = -constant / slope;
      const bool is_true = tau > 0 && std::abs(std::log(tau) - truth) < 1e-6;
      if (candidate.is_coplanar) {
        ASSERT_TRUE(is_true) << tau << " instead of " << std::exp(truth);
        ++right;
      } else {
        ++wrong;
        wrong_but_true += is_true;
      }
    }
  }
  EXPECT_GT(right, 1000);
  EXPECT_GT(wrong, 500);
  EXPECT_EQ(wrong_but_true, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, CandidatesOfKind,
    ::testing::Values(SyntheticKind::kRoom, SyntheticKind::kCorridor,
                      SyntheticKind::kRing, SyntheticKind::kPlanar),
    [](const auto& kind) { return SyntheticKindName(kind.param); });

TEST(CoplanarCandidates, NeverPairATrackWithItself) {
  const Result<SyntheticScene> synthetic = Simulate({});
  ASSERT_THAT(synthetic, IsOk());
  std::set<std::pair<FeatureIndex, FeatureIndex>> seen;
  const auto candidates = CoplanarCandidates(*synthetic, {0, 1, 2});
  ASSERT_FALSE(candidates.empty());
  for (const CoplanarCandidate& candidate : candidates) {
    EXPECT_NE(candidate.line_in_first, candidate.line_in_last);
    EXPECT_TRUE(
        seen.insert({candidate.line_in_first, candidate.line_in_last}).second);
  }
}

TEST(CoplanarCandidates, NoneWithoutThePairs) {
  const Result<SyntheticScene> synthetic = Simulate({});
  ASSERT_THAT(synthetic, IsOk());
  EXPECT_TRUE(CoplanarCandidates(*synthetic, {0, 1, 3}).empty());
}

}  // namespace
}  // namespace lowlap
