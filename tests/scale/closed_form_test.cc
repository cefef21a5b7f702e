// The closed forms against the truth, against brute force over tau, and in
// every degenerate case.

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "lowlap/core/random.h"
#include "lowlap/geometry/closest_direction.h"
#include "lowlap/geometry/triangulation.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/trifocal_line.h"
#include "lowlap/scale/evidence/internal/trifocal_point.h"
#include "scale/synthetic_room.h"
#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::MakeSegment;
using testing::MakeSyntheticTriplet;
using testing::SwapEnds;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

// i one unit to the left, k two units to the right and a little ahead; no
// rotation; the true ratio is |c_k|.
struct Rig {
  Vec3 center_i{-1, 0, 0};
  Vec3 center_k{2, 0.3, 0.5};
  TripletGeometry geometry;

  Rig() {
    geometry.cami_from_camj = {Mat3::Identity(), -center_i};
    geometry.camk_from_camj = {Mat3::Identity(), -center_k.normalized()};
    geometry.focal_i_px = geometry.focal_j_px = geometry.focal_k_px = 1000;
  }
  double LogRatio() const { return std::log(center_k.norm()); }
  TrifocalPoint Point(const Vec3& x) const {
    const auto ray = [](const Vec3& v) { return Vec3(v / v.z()); };
    return {0, ray(x - center_i), ray(x), ray(x - center_k)};
  }
  ObservedSegment See(const Vec3& center, const Vec3& a, const Vec3& b) const {
    return {MakeSegment(a - center, b - center), 0.5};
  }
  TrifocalLine Line(const Vec3& a, const Vec3& b) const {
    return {0, See(center_i, a, b), See(Vec3::Zero(), a, b),
            See(center_k, a, b)};
  }
  MatchedLine WithI(const Vec3& a, const Vec3& b) const {
    return {0, See(Vec3::Zero(), a, b), See(center_i, a, b)};
  }
  MatchedLine WithK(const Vec3& a, const Vec3& b) const {
    return {1, See(Vec3::Zero(), a, b), See(center_k, a, b)};
  }
};

TEST(TrifocalPointSolver, ExactWithoutNoise) {
  SyntheticTripletOptions options;
  options.num_points = 200;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 1);
  for (const TrifocalPoint& point : triplet.view.points) {
    const RatioCandidate ratio =
        TrifocalPointSolver(triplet.view.geometry).Ratio(point);
    ASSERT_EQ(ratio.status, CandidateStatus::kValid);
    EXPECT_NEAR(ratio.log_ratio, triplet.true_log_ratio, 1e-9);
    EXPECT_GT(ratio.log_ratio_stddev, 0);
  }
}

TEST(TrifocalLineRatio, ExactWithoutNoise) {
  SyntheticTripletOptions options;
  options.num_lines = 100;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 2);
  int valid = 0;
  for (const TrifocalLine& line : triplet.view.lines) {
    const RatioCandidate ratio = TrifocalLineRatio(triplet.view.geometry, line);
    if (ratio.status != CandidateStatus::kValid) continue;
    ++valid;
    EXPECT_NEAR(ratio.log_ratio, triplet.true_log_ratio,
                1e-9 + 1e-7 * ratio.log_ratio_stddev);
  }
  EXPECT_GE(valid, 90);
}

TEST(CoplanarRatio, ExactWithoutNoiseOnEveryWall) {
  SyntheticTripletOptions options;
  options.num_lines_ij = 60;
  options.num_lines_jk = 60;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 3);
  int right = 0;
  for (const CoplanarPairCandidate& pair : triplet.view.coplanar.pairs) {
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
  for (const CoplanarPairCandidate& pair : triplet.view.coplanar.pairs) {
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

// Each one-ended tau minimises its angle: compare with a dense scan.
TEST(TrifocalTau, IsTheMinimumOfABruteForceScan) {
  SyntheticTripletOptions options;
  options.num_points = 20;
  options.num_lines = 20;
  options.noise_px = 2;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 5);
  const TripletGeometry& g = triplet.view.geometry;
  const auto scan = [](const Vec3& u, const Vec3& v, const Vec3& w) {
    double best = 0, best_sine = 10;
    for (double log_tau = -4; log_tau < 4; log_tau += 1e-4) {
      const Vec3 p = v + std::exp(log_tau) * w;
      const double sine = u.cross(p).norm() / (u.norm() * p.norm());
      if (sine < best_sine) best = log_tau, best_sine = sine;
    }
    return best;
  };
  CandidateStatus status;
  const TrifocalPointSolver solver(g);
  for (const TrifocalPoint& point : triplet.view.points) {
    const RatioCandidate ratio = solver.Ratio(point);
    ASSERT_EQ(ratio.status, CandidateStatus::kValid);
    const Vec3 from_i =
        *TriangulateMidpoint(g.cami_from_camj, point.in_j, point.in_i);
    const Vec3 from_k =
        *TriangulateMidpoint(g.camk_from_camj, point.in_j, point.in_k);
    const double ijk = scan(point.in_k, g.camk_from_camj.rotation * from_i,
                            g.camk_from_camj.translation);
    const double kji = scan(point.in_i, g.cami_from_camj.rotation * from_k,
                            g.cami_from_camj.translation);
    EXPECT_NEAR(ratio.log_ratio, 0.5 * (ijk - kji), 2e-4);
  }
  for (const TrifocalLine& line : triplet.view.lines) {
    const std::optional<double> tau = TrifocalLineTau(g, line, &status);
    if (!tau) continue;
    const PluckerLine in_j = *LineInMiddle(g.cami_from_camj, line.in_j.segment,
                                           line.in_i.segment, &status);
    const Mat3& r = g.camk_from_camj.rotation;
    EXPECT_NEAR(std::log(*tau),
                scan(line.in_k.segment.normal, r * in_j.moment,
                     g.camk_from_camj.translation.cross(r * in_j.direction)),
                2e-4);
  }
}

TEST(Candidates, SwappingTheEndsNegatesTheLogRatio) {
  SyntheticTripletOptions options;
  options.num_points = 30;
  options.num_lines = 30;
  options.num_lines_ij = options.num_lines_jk = 30;
  options.noise_px = 1;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 6);
  const TripletView swapped = SwapEnds(triplet.view);
  const auto expect_negated = [](const RatioCandidate& a,
                                 const RatioCandidate& b) {
    ASSERT_EQ(a.status == CandidateStatus::kValid,
              b.status == CandidateStatus::kValid);
    if (a.status != CandidateStatus::kValid) return;
    EXPECT_NEAR(a.log_ratio, -b.log_ratio, 1e-12);
    EXPECT_NEAR(a.log_ratio_stddev, b.log_ratio_stddev, 1e-9);
  };
  for (int n = 0; n < 30; ++n) {
    expect_negated(
        TrifocalPointSolver(triplet.view.geometry)
            .Ratio(triplet.view.points[n]),
        TrifocalPointSolver(swapped.geometry).Ratio(swapped.points[n]));
    expect_negated(
        TrifocalLineRatio(triplet.view.geometry, triplet.view.lines[n]),
        TrifocalLineRatio(swapped.geometry, swapped.lines[n]));
    expect_negated(
        CoplanarRatio(triplet.view.geometry, triplet.view.lines_ij[n],
                      triplet.view.lines_jk[n]),
        CoplanarRatio(swapped.geometry, swapped.lines_ij[n],
                      swapped.lines_jk[n]));
  }
}

// The stated standard deviations against the spread over noise draws.
TEST(Candidates, StandardDeviationsAreThoseOfTheNoise) {
  const Rig rig;
  constexpr int kDraws = 4000;
  constexpr double kNoisePx = 0.5;
  Random random(8);
  const auto noisy = [&](const ObservedSegment& observed) {
    const auto move = [&](const Vec3& p) {
      const double x = random.Gaussian(kNoisePx / 1000);
      return Vec3(p + Vec3(x, random.Gaussian(kNoisePx / 1000), 0));
    };
    const Vec3 start = move(observed.segment.start);
    return ObservedSegment{MakeSegment(start, move(observed.segment.end)),
                           kNoisePx};
  };
  // Tilted wall z = 5 + 0.3 x; lines of different length and slope.
  const auto on_wall = [](double x, double y) {
    return Vec3(x, y, 5 + 0.3 * x);
  };
  const MatchedLine a = rig.WithI(on_wall(-1, -1), on_wall(-0.2, 1));
  const MatchedLine b = rig.WithK(on_wall(0, -0.5), on_wall(1.2, 0.9));
  const TrifocalLine line = rig.Line(on_wall(-0.5, -1), on_wall(0.3, 1));
  const double pair_stddev = CoplanarRatio(rig.geometry, a, b).log_ratio_stddev;
  double pair_sum = 0, line_sum = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const RatioCandidate pair = CoplanarRatio(
        rig.geometry, {0, noisy(a.in_middle), noisy(a.in_neighbor)},
        {1, noisy(b.in_middle), noisy(b.in_neighbor)});
    ASSERT_EQ(pair.status, CandidateStatus::kValid);
    pair_sum += std::pow(pair.log_ratio - rig.LogRatio(), 2);
    const RatioCandidate three = TrifocalLineRatio(
        rig.geometry,
        {0, noisy(line.in_i), noisy(line.in_j), noisy(line.in_k)});
    ASSERT_EQ(three.status, CandidateStatus::kValid);
    line_sum += std::pow(three.log_ratio - rig.LogRatio(), 2);
  }
  EXPECT_NEAR(std::sqrt(pair_sum / kDraws) / pair_stddev, 1.0, 0.08);
  EXPECT_NEAR(std::sqrt(line_sum / kDraws) /
                  TrifocalLineRatio(rig.geometry, line).log_ratio_stddev,
              1.0, 0.08);
}

TEST(TrifocalPointSolver, PointOnTheBaselineIsDegenerate) {
  Rig rig;
  rig.center_i = Vec3(0, 0, -1);  // the forward motion's baseline is the z axis
  rig.geometry.cami_from_camj = {Mat3::Identity(), -rig.center_i};
  EXPECT_EQ(
      TrifocalPointSolver(rig.geometry).Ratio(rig.Point({0, 0, 4})).status,
      CandidateStatus::kDegenerate);
  // On the line of the other baseline: visible, and without parallax in k.
  Rig other;
  other.center_k = Vec3(0.1, 0, 1);
  other.geometry.camk_from_camj = {Mat3::Identity(),
                                   -other.center_k.normalized()};
  EXPECT_EQ(TrifocalPointSolver(other.geometry)
                .Ratio(other.Point(4 * other.center_k))
                .status,
            CandidateStatus::kDegenerate);
}

TEST(TrifocalPointSolver, NegativeDepthIsToldApart) {
  const Rig rig;
  TrifocalPoint point = rig.Point({0.3, 0.2, 5});
  // The parallax of i reversed: the rays meet behind the cameras.
  std::swap(point.in_i, point.in_j);
  EXPECT_EQ(TrifocalPointSolver(rig.geometry).Ratio(point).status,
            CandidateStatus::kNegativeDepth);
}

TEST(TrifocalLineRatio, LineInAnEpipolarPlaneIsDegenerate) {
  const Rig rig;
  // Parallel to the baseline of (i, j).
  EXPECT_EQ(TrifocalLineRatio(rig.geometry, rig.Line({-1, 0.5, 5}, {1, 0.5, 5}))
                .status,
            CandidateStatus::kDegenerate);
  // In an epipolar plane of (j, k) only, parallel to the baseline and not.
  const Vec3 x(0.2, -0.4, 5);
  EXPECT_EQ(
      TrifocalLineRatio(rig.geometry, rig.Line(x, 0.3 * rig.center_k + 1.1 * x))
          .status,
      CandidateStatus::kDegenerate);
  EXPECT_EQ(TrifocalLineRatio(rig.geometry, rig.Line(x, x + 0.7 * rig.center_k))
                .status,
            CandidateStatus::kDegenerate);
}

TEST(TrifocalLineRatio, NegativeDepthIsToldApart) {
  const Rig rig;
  TrifocalLine line = rig.Line({0.2, -1, 5}, {0.4, 1, 5});
  std::swap(line.in_i, line.in_j);
  EXPECT_EQ(TrifocalLineRatio(rig.geometry, line).status,
            CandidateStatus::kNegativeDepth);
}

TEST(TrifocalLineRatio, SegmentWithoutLengthIsDegenerate) {
  const Rig rig;
  TrifocalLine line = rig.Line({0.2, -1, 5}, {0.4, 1, 5});
  line.in_k.segment.normal.setZero();
  EXPECT_EQ(TrifocalLineRatio(rig.geometry, line).status,
            CandidateStatus::kDegenerate);
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
