#include "lowlap/averaging/translation_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

// Views 2, 5, 6 and 9 with exact relative poses 2-5, 5-6, 6-9 and 2-6.
class MakeTranslationProblemTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Random random(1);
    for (const ViewId view : {2, 5, 6, 9}) {
      rotation_of_[view] = RandomRotation(&random);
      center_of_[view] = RandomVector(&random, 5);
    }
    for (const ViewPair& pair :
         {ViewPair{2, 5}, ViewPair{5, 6}, ViewPair{6, 9}, ViewPair{2, 6}}) {
      RelativePose& pose = scene_.relative_poses[pair];
      pose.views = pair;
      pose.rotation =
          rotation_of_[pair.second] * rotation_of_[pair.first].transpose();
      pose.direction = (rotation_of_[pair.second] *
                        (center_of_[pair.first] - center_of_[pair.second]))
                           .normalized();
    }
    AddRatio({2, 5, 6}, RatioVerdict::kMeaningful);
    // Written the other way round: from 9 to 5.
    AddRatio({9, 6, 5}, RatioVerdict::kMeaningful);
    AddRatio({5, 2, 6}, RatioVerdict::kNotMeaningful);
  }

  double Length(ViewId a, ViewId b) const {
    return (center_of_.at(a) - center_of_.at(b)).norm();
  }

  void AddRatio(const ViewTriplet& views, RatioVerdict verdict) {
    ScaleRatio ratio;
    ratio.views = views;
    ratio.verdict = verdict;
    ratio.log_ratio = std::log(Length(views.middle, views.last) /
                               Length(views.first, views.middle));
    ratio.log_ratio_stddev = 0.04;
    ratio.log10_nfa = -9;
    scene_.scale_ratios.push_back(ratio);
  }

  Vec3 CenterOf(const TranslationProblem& problem, std::size_t n) const {
    return center_of_.at(problem.views[n]);
  }

  Scene scene_;
  std::map<ViewId, Mat3> rotation_of_;
  std::map<ViewId, Vec3> center_of_;
};

TEST_F(MakeTranslationProblemTest, DirectionsPointFromCentreToCentre) {
  const TranslationProblem problem =
      MakeTranslationProblem(scene_, rotation_of_, {});
  EXPECT_EQ(problem.views, (std::vector<ViewId>{2, 5, 6, 9}));
  ASSERT_EQ(problem.edges.size(), 4u);
  for (const DirectionEdge& edge : problem.edges) {
    const Vec3 offset =
        CenterOf(problem, edge.second) - CenterOf(problem, edge.first);
    EXPECT_LT((edge.direction_in_world - offset.normalized()).norm(), 1e-12);
  }
  EXPECT_TRUE(ValidateProblem(problem));
}

TEST_F(MakeTranslationProblemTest, RatiosAreThoseOfTheirEdges) {
  const TranslationProblem problem =
      MakeTranslationProblem(scene_, rotation_of_, {});
  ASSERT_EQ(problem.ratios.size(), 2u);
  for (const RatioMeasurement& ratio : problem.ratios) {
    const auto length = [&](std::size_t e) {
      const DirectionEdge& edge = problem.edges[e];
      return Length(problem.views[edge.first], problem.views[edge.second]);
    };
    EXPECT_NEAR(ratio.log_ratio,
                std::log(length(ratio.target) / length(ratio.reference)),
                1e-12);
    EXPECT_DOUBLE_EQ(ratio.stddev, std::hypot(0.04, 1e-3));
    EXPECT_EQ(ratio.log10_nfa, -9);
  }
}

TEST_F(MakeTranslationProblemTest, WhatIsExcludedTakesItsRatiosAlong) {
  const TranslationProblem problem =
      MakeTranslationProblem(scene_, rotation_of_, {{6, 9}});
  EXPECT_EQ(problem.views.size(), 4u);
  EXPECT_EQ(problem.edges.size(), 3u);
  ASSERT_EQ(problem.ratios.size(), 1u);
  EXPECT_EQ(problem.ratios[0].views, (ViewTriplet{2, 5, 6}));
}

TEST_F(MakeTranslationProblemTest, ViewsWithoutARotationTakeNoPart) {
  rotation_of_.erase(5);
  const TranslationProblem problem =
      MakeTranslationProblem(scene_, rotation_of_, {});
  EXPECT_EQ(problem.views, (std::vector<ViewId>{2, 6, 9}));
  EXPECT_EQ(problem.edges.size(), 2u);
  EXPECT_TRUE(problem.ratios.empty());
}

TEST_F(MakeTranslationProblemTest, WeakRatiosComeOnlyOnRequestAndAsWeak) {
  scene_.scale_ratios[2].log_ratio_stddev = 0.15;
  const TranslationProblem problem =
      MakeTranslationProblem(scene_, rotation_of_, {}, {{5, 2, 6}});
  ASSERT_EQ(problem.ratios.size(), 3u);
  EXPECT_EQ(problem.ratios[2].views, (ViewTriplet{5, 2, 6}));
  EXPECT_DOUBLE_EQ(problem.ratios[2].stddev, 0.25);  // of 0.15 and 0.2
}

TEST_F(MakeTranslationProblemTest, DeviationsAreThoseOfTheDirection) {
  Eigen::Matrix<double, 5, 5> covariance =
      Eigen::Matrix<double, 5, 5>::Identity();
  covariance(3, 3) = 1e-4;
  covariance(4, 4) = 3e-4;
  scene_.relative_poses.at({2, 5}).covariance = covariance;
  scene_.relative_poses.at({5, 6}).covariance =
      Eigen::Matrix<double, 5, 5>::Zero();
  const TranslationProblem problem =
      MakeTranslationProblem(scene_, rotation_of_, {});
  for (const DirectionEdge& edge : problem.edges) {
    const ViewPair pair = {problem.views[edge.first],
                           problem.views[edge.second]};
    if (pair == ViewPair{2, 5}) {
      EXPECT_DOUBLE_EQ(
          edge.stddev_rad,
          std::sqrt(2e-4 + kPoseErrorFloorRad * kPoseErrorFloorRad));
    } else if (pair == ViewPair{5, 6}) {
      EXPECT_DOUBLE_EQ(edge.stddev_rad, kPoseErrorFloorRad);
    } else {
      EXPECT_GT(edge.stddev_rad, kPoseErrorFloorRad);  // not known
    }
  }
}

TEST(ValidateProblem, RefusesEveryWrongMember) {
  const double nan = std::nan("");
  RandomProblem made = MakeRandomProblem(
      3, std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {1, 2}}, 2);
  made.problem.tracks.resize(1);
  made.problem.tracks[0].observations = {{0, Vec3::UnitX()},
                                         {2, Vec3::UnitY()}};
  ASSERT_TRUE(ValidateProblem(made.problem));
  EXPECT_TRUE(ValidateProblem(TranslationProblem()));
  const std::vector<std::function<void(TranslationProblem*)>> wrongs = {
      [](auto* p) { p->cam_from_world.pop_back(); },
      [](auto* p) { p->views.pop_back(); },
      [nan](auto* p) { p->cam_from_world[1](0, 2) = nan; },
      [](auto* p) { p->edges[1].second = 3; },
      [](auto* p) { p->edges[1].first = 3; },
      [](auto* p) { p->edges[1].second = p->edges[1].first; },
      [](auto* p) { p->edges[0].direction_in_world *= 1.01; },
      [](auto* p) { p->edges[0].direction_in_world.setZero(); },
      [nan](auto* p) { p->edges[0].direction_in_world.x() = nan; },
      [](auto* p) { p->edges[0].stddev_rad = 0; },
      [nan](auto* p) { p->edges[0].stddev_rad = nan; },
      [](auto* p) { p->edges[0].stddev_rad = HUGE_VAL; },
      [](auto* p) { p->ratios[0].target = 2; },
      [](auto* p) { p->ratios[0].reference = 2; },
      [](auto* p) { p->ratios[0].target = p->ratios[0].reference; },
      [nan](auto* p) { p->ratios[0].log_ratio = nan; },
      [](auto* p) { p->ratios[0].log_ratio = -HUGE_VAL; },
      [](auto* p) { p->ratios[0].stddev = -0.1; },
      [nan](auto* p) { p->ratios[0].stddev = nan; },
      [](auto* p) { p->ratios[0].stddev = HUGE_VAL; },
      [nan](auto* p) { p->ratios[0].log10_nfa = nan; },
      [](auto* p) { p->tracks[0].observations[1].view = 3; },
      [](auto* p) { p->tracks[0].observations[1].ray_in_world *= 2; },
      [nan](auto* p) { p->tracks[0].observations[1].ray_in_world.y() = nan; },
  };
  for (std::size_t n = 0; n < wrongs.size(); ++n) {
    TranslationProblem problem = made.problem;
    wrongs[n](&problem);
    const Status status = ValidateProblem(problem);
    ASSERT_FALSE(status) << n;
    EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument) << n;
  }
}

}  // namespace
}  // namespace lowlap
