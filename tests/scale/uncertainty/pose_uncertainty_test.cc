#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/internal/candidate_limits.h"
#include "scale/even_evidence.h"

namespace lowlap {
namespace {

using Mat5 = Eigen::Matrix<double, 5, 5>;
using Vec5 = Eigen::Matrix<double, 5, 1>;

RelativePose Edge() {
  RelativePose edge;
  edge.views = {1, 2};
  edge.rotation = RotationFromAngleAxis({0.1, 0.2, -0.1});
  edge.direction = Vec3(1, 0.2, 0.1).normalized();
  return edge;
}

TripletGeometry GeometryOf(const RelativePose& edge) {
  TripletGeometry geometry;
  geometry.camk_from_camj = UnitTransform(edge, 1, 2);
  return geometry;
}

TEST(PerturbPose, IsEmptyWithoutAUsableCovariance) {
  RelativePose edge = Edge();
  EXPECT_TRUE(PerturbPose({}, edge, {0, 1, 2}).empty());
  edge.covariance = Mat5::Identity() * std::numeric_limits<double>::infinity();
  EXPECT_TRUE(PerturbPose({}, edge, {0, 1, 2}).empty());
  Mat5 indefinite = Mat5::Identity();
  indefinite(2, 2) = -1;
  edge.covariance = indefinite;
  EXPECT_TRUE(PerturbPose({}, edge, {0, 1, 2}).empty());
}

// Small errors: their squares add up to twice the covariance.
TEST(PerturbPose, SpansTheCovariance) {
  RelativePose edge = Edge();
  Mat5 root;
  for (int n = 0; n < 25; ++n) root(n / 5, n % 5) = 1e-5 * std::sin(3.0 * n);
  const Mat5 covariance = root * root.transpose();
  edge.covariance = covariance;
  const TripletGeometry geometry = GeometryOf(edge);
  const auto perturbed = PerturbPose(geometry, edge, {0, 1, 2});
  ASSERT_EQ(perturbed.size(), 10u);
  Mat5 sum = Mat5::Zero();
  for (const TripletGeometry& moved : perturbed) {
    EXPECT_EQ(moved.cami_from_camj.rotation, geometry.cami_from_camj.rotation);
    EXPECT_NEAR(moved.camk_from_camj.translation.norm(), 1, 1e-12);
    const Mat3 turn = moved.camk_from_camj.rotation * edge.rotation.transpose();
    Vec5 error;
    error << turn(2, 1), turn(0, 2), turn(1, 0),
        TangentBasis(edge.direction).transpose() *
            (moved.camk_from_camj.translation - edge.direction);
    sum += 0.5 * error * error.transpose();
  }
  EXPECT_LT((sum - covariance).norm(), 1e-4 * covariance.norm());
}

// Which way an eigenvector points is chance.
TEST(PerturbPose, GoesBothWays) {
  RelativePose edge = Edge();
  edge.covariance = 0.04 * Mat5::Identity();
  const auto perturbed = PerturbPose(GeometryOf(edge), edge, {0, 1, 2});
  ASSERT_EQ(perturbed.size(), 10u);
  for (std::size_t n = 0; n < perturbed.size(); n += 2) {
    const RigidTransform& there = perturbed[n].camk_from_camj;
    const RigidTransform& back = perturbed[n + 1].camk_from_camj;
    EXPECT_LT((there.rotation * edge.rotation.transpose() * back.rotation -
               edge.rotation)
                  .norm(),
              1e-12);
    const Vec3 mean = there.translation + back.translation;
    EXPECT_LT(mean.cross(edge.direction).norm(), 1e-12);
  }
}

// Its candidates move with the focal length of view i, of all geometries, or,
// if `by_ratio`, by as many of their own ratios. Beyond 1 there are none.
class MovedByGeometry : public testing::EvenEvidence {
 public:
  MovedByGeometry(std::vector<double> ratios, double num_tests,
                  bool by_ratio = false)
      : EvenEvidence(std::move(ratios), num_tests), by_ratio_(by_ratio) {}
  std::vector<RatioCandidate> RatiosIn(
      const TripletView&, const TripletGeometry& geometry,
      const std::vector<int>& candidates) const override {
    std::vector<RatioCandidate> moved;
    for (const int n : candidates) {
      moved.push_back(ratios()[n]);
      moved.back().log_ratio +=
          geometry.focal_i_px * (by_ratio_ ? ratios()[n].log_ratio : 1);
      if (std::abs(geometry.focal_i_px) > 1) {
        moved.back().status = CandidateStatus::kNegativeDepth;
      }
    }
    return moved;
  }

 private:
  bool by_ratio_;
};

TEST(PoseVariance, DoesNotFallWithTheNumberOfCandidates) {
  TripletView triplet;
  for (const double change : {0.03, -0.03, 0.04, -0.04}) {
    triplet.pose_perturbations.emplace_back().focal_i_px = change;
  }
  for (const int count : {1, 10, 100}) {
    const RatioSupport support(
        testing::EvidenceOf({std::make_shared<MovedByGeometry>(
            std::vector<double>(count, 0.5), 1)}));
    std::vector<WeightedCandidate> candidates;
    for (int n = 0; n < count; ++n) candidates.push_back({0, n, 1.0 + n});
    EXPECT_NEAR(PoseVariance(triplet, support, candidates), 0.05 * 0.05, 1e-12);
  }
}

// Along a valley of poses the ratio changes on one side alone.
TEST(PoseVariance, TakesTheMeanOfBothWays) {
  TripletView triplet;
  triplet.pose_perturbations.emplace_back().focal_i_px = 0.07;
  triplet.pose_perturbations.emplace_back().focal_i_px = 0.01;
  const RatioSupport support(testing::EvidenceOf(
      {std::make_shared<MovedByGeometry>(std::vector<double>{0}, 1)}));
  const double variance = PoseVariance(triplet, support, {{0, 0, 1}});
  EXPECT_NEAR(variance, 0.05 * 0.05, 1e-15);
  std::swap(triplet.pose_perturbations[0], triplet.pose_perturbations[1]);
  EXPECT_EQ(PoseVariance(triplet, support, {{0, 0, 1}}), variance);
}

// As a motion whose direction nothing determines has them.
TEST(PoseVariance, IsLargeWhereAnErrorLeavesNoRatioEitherWay) {
  const RatioSupport support(testing::EvidenceOf(
      {std::make_shared<MovedByGeometry>(std::vector<double>{0}, 1),
       testing::Even({0}, 1)}));
  const auto variance = [&](double there, double back,
                            const std::vector<WeightedCandidate>& candidates) {
    TripletView triplet;
    triplet.pose_perturbations.emplace_back().focal_i_px = there;
    triplet.pose_perturbations.emplace_back().focal_i_px = back;
    return PoseVariance(triplet, support, candidates);
  };
  EXPECT_EQ(variance(2, -2, {{0, 0, 1}}),
            kMaxLogRatioStddev * kMaxLogRatioStddev);
  EXPECT_NEAR(variance(0.04, -2, {{0, 0, 1}}), 0.04 * 0.04 / 2, 1e-15);
  EXPECT_NEAR(variance(-2, 0.04, {{0, 0, 1}}), 0.04 * 0.04 / 2, 1e-15);
  EXPECT_EQ(variance(2, -2, {{0, 0, 1}, {1, 0, 1}}), 0);
}

// As a relative pose that few matches bear out has it: the candidates that are
// left after such a turn are there by chance.
TEST(PoseVariance, IsLargeWhereARotationIsOpen) {
  const RatioSupport support(testing::EvidenceOf(
      {std::make_shared<MovedByGeometry>(std::vector<double>{0}, 1)}));
  const auto variance = [&](double step_rad, bool is_ij) {
    TripletView triplet;
    for (const double step : {step_rad, -step_rad}) {
      TripletGeometry& moved = triplet.pose_perturbations.emplace_back();
      (is_ij ? moved.cami_from_camj : moved.camk_from_camj).rotation =
          RotationFromAngleAxis({0, step, 0});
      moved.focal_i_px = 0.01 * step;
    }
    triplet.geometry.focal_i_px = 0;
    return PoseVariance(triplet, support, {{0, 0, 1}});
  };
  for (const bool is_ij : {false, true}) {
    EXPECT_EQ(variance(0.9, is_ij), kMaxLogRatioStddev * kMaxLogRatioStddev);
    EXPECT_NEAR(variance(0.2, is_ij), 0.002 * 0.002, 1e-15);
  }
}

TEST(PoseVariance, AveragesWhatMovesAndWhatDoesNot) {
  TripletView triplet;
  triplet.pose_perturbations.emplace_back().focal_i_px = 0.04;
  triplet.pose_perturbations.emplace_back().focal_i_px = -0.04;
  const RatioSupport support(testing::EvidenceOf(
      {std::make_shared<MovedByGeometry>(std::vector<double>{0}, 1),
       testing::Even({0}, 1)}));
  EXPECT_NEAR(PoseVariance(triplet, support, {{0, 0, 1}, {1, 0, 3}}),
              0.01 * 0.01, 1e-15);
  EXPECT_EQ(PoseVariance(triplet, support, {}), 0);
  EXPECT_EQ(PoseVariance({}, support, {{0, 0, 1}}), 0);
}

TEST(PoseVariance, DoesNotDependOnTheOrderOfTheCandidates) {
  TripletView triplet;
  triplet.pose_perturbations.emplace_back().focal_i_px = 0.04;
  std::vector<double> ratios;
  std::vector<WeightedCandidate> candidates;
  for (int n = 0; n < 60; ++n) {
    ratios.push_back(std::fmod(0.618 * n, 1.0));
    candidates.push_back({0, n, 1.0 + n % 7});
  }
  const RatioSupport support(testing::EvidenceOf(
      {std::make_shared<MovedByGeometry>(ratios, 1, true)}));
  const double variance = PoseVariance(triplet, support, candidates);
  std::rotate(candidates.begin(), candidates.begin() + 1, candidates.end());
  EXPECT_NEAR(PoseVariance(triplet, support, candidates), variance,
              1e-12 * variance);
  std::reverse(candidates.begin(), candidates.end());
  EXPECT_NEAR(PoseVariance(triplet, support, candidates), variance,
              1e-12 * variance);
}

}  // namespace
}  // namespace lowlap
