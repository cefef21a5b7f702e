#include "lowlap/scale/evidence/internal/coplanar_candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"
#include "scale/rig.h"

namespace lowlap {
namespace {

using testing::MakeSegment;
using testing::NoisyTriplet;
using testing::SyntheticTriplet;

TEST(SegmentDistance, IsTheLeastOverSampledPoints) {
  Random random(3);
  const auto point = [&] {
    const double x = random.Uniform(-1, 1);
    return Vec3(x, random.Uniform(-1, 1), 1);
  };
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 a1 = point(), a2 = point(), b1 = point(), b2 = point();
    double least = 1e9;
    for (int s = 0; s <= 100; ++s) {
      for (int t = 0; t <= 100; ++t) {
        least = std::min(
            least,
            (a1 + 0.01 * s * (a2 - a1) - b1 - 0.01 * t * (b2 - b1)).norm());
      }
    }
    EXPECT_NEAR(SegmentDistance(MakeSegment(a1, a2), MakeSegment(b1, b2)),
                least, 0.03);
    EXPECT_LE(SegmentDistance(MakeSegment(a1, a2), MakeSegment(b1, b2)),
              least + 1e-12);
  }
}

TEST(FindCoplanarCandidates, AreTheNearestUsableLinesBothWays) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletView& view = triplet.view;
  constexpr int kNeighbors = 3;
  using Pair = std::pair<int, int>;
  const auto usable = [](const RigidTransform& pose, const MatchedLine& line) {
    CandidateStatus status;
    return LineInMiddle(pose, line.in_middle.segment, line.in_neighbor.segment,
                        &status)
        .has_value();
  };
  std::set<Pair> expected;
  const auto add_nearest = [&](std::vector<std::pair<double, Pair>> all) {
    std::sort(all.begin(), all.end());
    if (all.size() > kNeighbors) all.resize(kNeighbors);
    for (const auto& [distance, pair] : all) expected.insert(pair);
  };
  const int num_a = static_cast<int>(view.lines_ij.size());
  const int num_b = static_cast<int>(view.lines_jk.size());
  std::vector<std::vector<std::pair<double, Pair>>> by_a(num_a), by_b(num_b);
  for (int a = 0; a < num_a; ++a) {
    for (int b = 0; b < num_b; ++b) {
      const MatchedLine& line_a = view.lines_ij[a];
      const MatchedLine& line_b = view.lines_jk[b];
      if (!usable(view.geometry.cami_from_camj, line_a) ||
          !usable(view.geometry.camk_from_camj, line_b)) {
        continue;
      }
      const RatioCandidate ratio = CoplanarRatio(view.geometry, line_a, line_b);
      if (ratio.status != CandidateStatus::kValid) continue;
      // The better ratio first among crossing segments.
      const double distance =
          SegmentDistance(line_a.in_middle.segment, line_b.in_middle.segment) +
          1e-12 * ratio.log_ratio_stddev;
      by_a[a].push_back({distance, {a, b}});
      by_b[b].push_back({distance, {a, b}});
    }
  }
  for (const auto& all : by_a) add_nearest(all);
  for (const auto& all : by_b) add_nearest(all);

  const CoplanarPairCandidates found = FindCoplanarCandidates(
      view.geometry, view.lines_ij, view.lines_jk, kNeighbors);
  std::set<Pair> pairs;
  for (const CoplanarPairCandidate& pair : found.pairs) {
    pairs.insert({pair.first, pair.last});
  }
  EXPECT_EQ(pairs.size(), found.pairs.size());
  EXPECT_EQ(pairs, expected);
}

TEST(FindCoplanarCandidates, LeaveOutASegmentPairedWithItself) {
  SyntheticTriplet triplet = NoisyTriplet();
  for (MatchedLine& line : triplet.view.lines_jk) line.segment_in_middle = 7;
  for (MatchedLine& line : triplet.view.lines_ij) line.segment_in_middle = 7;
  EXPECT_TRUE(FindCoplanarCandidates(triplet.view.geometry,
                                     triplet.view.lines_ij,
                                     triplet.view.lines_jk, 10)
                  .pairs.empty());
}

TEST(FindCoplanarCandidates, CountNegativeDepths) {
  SyntheticTriplet triplet = NoisyTriplet();
  // The other direction of the baseline: every line is behind the camera.
  triplet.view.geometry.cami_from_camj.translation *= -1;
  const CoplanarPairCandidates found = FindCoplanarCandidates(
      triplet.view.geometry, triplet.view.lines_ij, triplet.view.lines_jk, 10);
  EXPECT_TRUE(found.pairs.empty());
  EXPECT_GE(found.num_rejected_negative, 20);
}

}  // namespace
}  // namespace lowlap
