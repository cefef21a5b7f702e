// The array residuals against projections computed feature by feature, and
// the candidate pairs against a search over all pairs.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/core/random.h"
#include "lowlap/geometry/triangulation.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/ratio_residuals.h"
#include "lowlap/scale/evidence/internal/trifocal_line.h"
#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "scale/synthetic_room.h"
#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::MakeSegment;
using testing::MakeSyntheticTriplet;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

SyntheticTriplet NoisyTriplet() {
  SyntheticTripletOptions options;
  options.num_points = options.num_lines = 30;
  options.num_lines_ij = options.num_lines_jk = 30;
  options.noise_px = 1;
  return MakeSyntheticTriplet(options, 11);
}

Vec2 Project(const Vec3& x) { return x.head<2>() / x.z(); }

double ToLine(const Vec2& p, const Vec3& line) {
  return std::abs(line.dot(p.homogeneous())) / line.head<2>().norm();
}

// The triplet with its true-scale transforms at tau.
RigidTransform Scaled(const RigidTransform& unit, double lambda) {
  return {unit.rotation, lambda * unit.translation};
}

TEST(PointResiduals, AreMeanReprojectionDistances) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  ScaleOptions options;
  options.use_lines = options.use_coplanar = false;
  const RatioSupport support(triplet.view, options);
  for (const double off : {0.0, 0.05, -0.4}) {
    const double log_ratio = triplet.true_log_ratio + off;
    std::vector<float> errors_px;
    support.Errors(FeatureKind::kPoint, log_ratio, &errors_px);
    const RigidTransform k_from_j =
        Scaled(g.camk_from_camj, std::exp(log_ratio));
    for (int n = 0; n < support.num_points(); ++n) {
      const TrifocalPoint& point = triplet.view.points[support.PointOf(n)];
      const Vec3 from_i =
          *TriangulateMidpoint(g.cami_from_camj, point.in_j, point.in_i);
      const Vec3 from_k =
          *TriangulateMidpoint(k_from_j, point.in_j, point.in_k);
      const double expected =
          450.0 *
          ((Project(k_from_j * from_i) - Project(point.in_k)).norm() +
           (Project(g.cami_from_camj * from_k) - Project(point.in_i)).norm());
      EXPECT_NEAR(errors_px[n], expected, 0.01 + 1e-4 * expected);
    }
  }
}

TEST(LineResiduals, AreMeanEndPointDistances) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  ScaleOptions options;
  options.use_points = options.use_coplanar = false;
  const RatioSupport support(triplet.view, options);
  ASSERT_GT(support.num_lines(), 15);
  const double log_ratio = triplet.true_log_ratio + 0.1;
  std::vector<float> errors_px;
  support.Errors(FeatureKind::kLine, log_ratio, &errors_px);
  const RigidTransform k_from_j = Scaled(g.camk_from_camj, std::exp(log_ratio));
  const auto mean_distance = [](const RigidTransform& n_from_j,
                                const PluckerLine& line,
                                const NormalizedSegment& observed) {
    const Vec3 projected = (n_from_j * line).moment;
    return 0.5 * (ToLine(observed.start.head<2>(), projected) +
                  ToLine(observed.end.head<2>(), projected));
  };
  for (int n = 0; n < support.num_lines(); ++n) {
    const TrifocalLine& line = triplet.view.lines[support.LineOf(n)];
    const Vec3& l_j = line.in_j.segment.normal;
    const PluckerLine from_i =
        *LineFromTwoViews(g.cami_from_camj, l_j, line.in_i.segment.normal);
    const PluckerLine from_k =
        *LineFromTwoViews(k_from_j, l_j, line.in_k.segment.normal);
    const double expected =
        450.0 * (mean_distance(k_from_j, from_i, line.in_k.segment) +
                 mean_distance(g.cami_from_camj, from_k, line.in_i.segment));
    EXPECT_NEAR(errors_px[n], expected, 0.01 + 1e-4 * expected);
  }
}

TEST(TransferResiduals, CarryTheCrossingToTheOuterViews) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  ScaleOptions options;
  options.use_points = options.use_lines = false;
  const RatioSupport support(triplet.view, options);
  const double log_ratio = triplet.true_log_ratio - 0.1;
  std::vector<float> errors_px;
  support.Errors(FeatureKind::kCoplanar, log_ratio, &errors_px);
  const RigidTransform k_from_j = Scaled(g.camk_from_camj, std::exp(log_ratio));
  for (int n = 0; n < support.num_pairs(); ++n) {
    const MatchedLine& a = triplet.view.lines_ij[support.Pair(n).first];
    const MatchedLine& b = triplet.view.lines_jk[support.Pair(n).last];
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

TEST(PlaneResiduals, AreDistancesOfTheClosestPoints) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  ScaleOptions options;
  options.use_points = options.use_lines = false;
  options.coplanar_residual = CoplanarResidual::kPlane;
  const RatioSupport support(triplet.view, options);
  const double log_ratio = triplet.true_log_ratio + 0.05;
  std::vector<float> errors_px;
  support.Errors(FeatureKind::kCoplanar, log_ratio, &errors_px);
  const RigidTransform k_from_j = Scaled(g.camk_from_camj, std::exp(log_ratio));
  int compared = 0;
  for (int n = 0; n < support.num_pairs(); ++n) {
    const MatchedLine& a = triplet.view.lines_ij[support.Pair(n).first];
    const MatchedLine& b = triplet.view.lines_jk[support.Pair(n).last];
    const PluckerLine line_a =
        *LineFromTwoViews(g.cami_from_camj, a.in_middle.segment.normal,
                          a.in_neighbor.segment.normal);
    const PluckerLine line_b = *LineFromTwoViews(
        k_from_j, b.in_middle.segment.normal, b.in_neighbor.segment.normal);
    const Vec3 p_ab = *ClosestPointOnLine(line_a, line_b);
    const Vec3 p_ba = *ClosestPointOnLine(line_b, line_a);
    if (p_ab.z() < 0.1 || p_ba.z() < 0.1) continue;
    const double expected = 900.0 * (Project(p_ab) - Project(p_ba)).norm();
    EXPECT_NEAR(errors_px[n], expected, 0.02 + 1e-3 * expected);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

// A wall that faces camera j: the residual of the paper is blind to the ratio
// there, the transfer residual is not; on a tilted wall both react.
TEST(PlaneResiduals, AreBlindToAFrontalWallAndTransferResidualsAreNot) {
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
    PlaneResiduals plane;
    TransferResiduals transfer;
    plane.Add(geometry, a, b, log_ratio);
    transfer.Add(geometry, a, b, log_ratio);
    std::pair<float, float> result;
    plane.Evaluate(1.5 * 1.05, 1, &result.first);
    transfer.Evaluate(1.5 * 1.05, 1, &result.second);
    return result;
  };
  const auto [plane_frontal, transfer_frontal] = errors(0.0);
  EXPECT_LT(plane_frontal, 0.01);
  EXPECT_GT(transfer_frontal, 3);
  const auto [plane_tilted, transfer_tilted] = errors(0.4);
  EXPECT_GT(plane_tilted, 3);
  EXPECT_GT(transfer_tilted, 3);
}

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
