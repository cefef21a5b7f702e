#include "lowlap/scale/evidence/internal/trifocal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lowlap/geometry/internal/triangulation.h"
#include "lowlap/geometry/plucker_line.h"
#include "scale/rig.h"

namespace lowlap {
namespace {

using testing::Gather;
using testing::MakeSyntheticTriplet;
using testing::NoisyTriplet;
using testing::Project;
using testing::Rig;
using testing::Scaled;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;
using testing::ToLine;

TEST(TrifocalPoints, ErrorsAreMeanReprojectionDistances) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  const auto evidence = TrifocalPointKind().Gather(triplet.view);
  ASSERT_EQ(evidence->size(), static_cast<int>(triplet.view.points.size()));
  for (const double off : {0.0, 0.05, -0.4}) {
    const double log_ratio = triplet.true_log_ratio + off;
    std::vector<float> errors_px(evidence->size());
    evidence->Errors(std::exp(log_ratio), evidence->size(), errors_px.data());
    const RigidTransform k_from_j =
        Scaled(g.camk_from_camj, std::exp(log_ratio));
    for (int n = 0; n < evidence->size(); ++n) {
      const TripletPoint& point = triplet.view.points[n];
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

TEST(TrifocalLineRatio, ExactWithoutNoise) {
  SyntheticTripletOptions options;
  options.num_lines = 100;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 2);
  int valid = 0;
  for (const TripletLine& line : triplet.view.lines) {
    const RatioCandidate ratio = TrifocalLineRatio(triplet.view.geometry, line);
    if (ratio.status != CandidateStatus::kValid) continue;
    ++valid;
    EXPECT_NEAR(ratio.log_ratio, triplet.true_log_ratio,
                1e-9 + 1e-7 * ratio.log_ratio_stddev);
  }
  EXPECT_GE(valid, 90);
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
  TripletLine line = rig.Line({0.2, -1, 5}, {0.4, 1, 5});
  std::swap(line.in_i, line.in_j);
  EXPECT_EQ(TrifocalLineRatio(rig.geometry, line).status,
            CandidateStatus::kNegativeDepth);
}

TEST(TrifocalLineRatio, SegmentWithoutLengthIsDegenerate) {
  const Rig rig;
  TripletLine line = rig.Line({0.2, -1, 5}, {0.4, 1, 5});
  line.in_k.segment.normal.setZero();
  EXPECT_EQ(TrifocalLineRatio(rig.geometry, line).status,
            CandidateStatus::kDegenerate);
}

TEST(TrifocalLines, ErrorsAreMeanEndPointDistances) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  const auto evidence = TrifocalLineKind().Gather(triplet.view);
  ASSERT_GT(evidence->size(), 15);
  const double log_ratio = triplet.true_log_ratio + 0.1;
  std::vector<float> errors_px(evidence->size());
  evidence->Errors(std::exp(log_ratio), evidence->size(), errors_px.data());
  const RigidTransform k_from_j = Scaled(g.camk_from_camj, std::exp(log_ratio));
  const auto mean_distance = [](const RigidTransform& n_from_j,
                                const PluckerLine& line,
                                const NormalizedSegment& observed) {
    const Vec3 projected = (n_from_j * line).moment;
    return 0.5 * (ToLine(observed.start.head<2>(), projected) +
                  ToLine(observed.end.head<2>(), projected));
  };
  int n = 0;
  for (const TripletLine& line : triplet.view.lines) {
    if (TrifocalLineRatio(g, line).status != CandidateStatus::kValid) continue;
    const Vec3& l_j = line.in_j.segment.normal;
    const PluckerLine from_i =
        *LineFromTwoViews(g.cami_from_camj, l_j, line.in_i.segment.normal);
    const PluckerLine from_k =
        *LineFromTwoViews(k_from_j, l_j, line.in_k.segment.normal);
    const double expected =
        450.0 * (mean_distance(k_from_j, from_i, line.in_k.segment) +
                 mean_distance(g.cami_from_camj, from_k, line.in_i.segment));
    EXPECT_NEAR(errors_px[n++], expected, 0.01 + 1e-4 * expected);
  }
  EXPECT_EQ(n, evidence->size());
}

}  // namespace
}  // namespace lowlap
