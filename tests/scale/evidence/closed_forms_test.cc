#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/triangulation.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"
#include "lowlap/scale/evidence/internal/trifocal.h"
#include "lowlap/scale/evidence/internal/triplet_points.h"
#include "scale/rig.h"

namespace lowlap {
namespace {

using testing::MakeSegment;
using testing::MakeSyntheticTriplet;
using testing::Rig;
using testing::SwapEnds;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

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
  const TripletPointSolver solver(g);
  for (const TripletPoint& point : triplet.view.points) {
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
  for (const TripletLine& line : triplet.view.lines) {
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
        TripletPointSolver(triplet.view.geometry).Ratio(triplet.view.points[n]),
        TripletPointSolver(swapped.geometry).Ratio(swapped.points[n]));
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
  const TripletLine line = rig.Line(on_wall(-0.5, -1), on_wall(0.3, 1));
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

}  // namespace
}  // namespace lowlap
