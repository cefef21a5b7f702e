#include "lowlap/adjustment/internal/uncertainty/jackknife.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "line_chain.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/similarity.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using lowlap::testing::IsOk;
using test::AddCommonErrors;
using test::BuildAndAdjust;
using test::ChainOfLines;
using test::MakeTestScene;
using test::NormalisedCenterError;
using test::TestScene;

// The chain, and what is known of its centres: next to nothing is open.
class JackknifeTest : public ::testing::Test {
 protected:
  static constexpr double kVariance = 1e-12;

  explicit JackknifeTest(TestScene test = ChainOfLines(1))
      : test_(std::move(test)),
        summary_(BuildAndAdjust(&test_.scene)),
        cameras_(test_.scene) {
    state_.points = LoadPoints(test_.scene, cameras_);
    state_.lines = LoadLines(test_.scene, cameras_, false);
    noise_.points = {summary_.points.stddev_px, summary_.points.threshold_px};
    noise_.lines = {summary_.lines.stddev_px, summary_.lines.threshold_px};
    for (const auto& [id, pose] : test_.scene.poses) {
      uncertainty_.covariances[id] = kVariance * Mat3::Identity();
    }
    for (const auto& entry : test_.scene.relative_poses) {
      uncertainty_.direction_stddevs_rad[entry.first] = 0;
    }
  }

  Status Add(const RunContext& context = {}) {
    return AddJackknife({}, noise_, context, cameras_, state_, &uncertainty_);
  }

  TestScene test_;
  AdjustmentSummary summary_;
  CameraSet cameras_;
  StructureState state_;
  NoiseLevels noise_;
  CenterUncertainty uncertainty_;
};

TEST_F(JackknifeTest, AddsToEveryCentreAndDirection) {
  ASSERT_THAT(Add(), IsOk());
  for (const auto& [id, covariance] : uncertainty_.covariances) {
    EXPECT_GT(covariance.trace(), 1e3 * kVariance) << id;
    EXPECT_LT(covariance.trace(), 1e-2) << id;
  }
  for (const auto& [views, stddev_rad] : uncertainty_.direction_stddevs_rad) {
    EXPECT_GT(stddev_rad, 0);
    EXPECT_LT(stddev_rad, 0.1);
  }
}

TEST_F(JackknifeTest, IsTheSameForAnyNumberOfThreads) {
  RunContext context;
  context.num_threads = 1;
  ASSERT_THAT(Add(context), IsOk());
  const CenterUncertainty with_one = uncertainty_;
  for (auto& [id, covariance] : uncertainty_.covariances) {
    covariance = kVariance * Mat3::Identity();
  }
  context.num_threads = 3;
  ASSERT_THAT(Add(context), IsOk());
  for (const auto& [id, covariance] : uncertainty_.covariances) {
    EXPECT_GT(covariance.trace(), 1e3 * kVariance) << id;
    EXPECT_EQ(covariance, with_one.covariances.at(id)) << id;
  }
}

TEST_F(JackknifeTest, Stops) {
  RunContext context;
  context.progress = [](const std::string& stage, std::size_t, std::size_t) {
    return stage.find("jackknife") == std::string::npos;
  };
  const Status status = Add(context);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kCancelled);
}

class WellSeenTest : public JackknifeTest {
 protected:
  WellSeenTest() : JackknifeTest(MakeTestScene({})) {}
};

TEST_F(WellSeenTest, AddsNothingWhereMoreViewsCheckEachOther) {
  ASSERT_THAT(Add(), IsOk());
  for (const auto& [id, covariance] : uncertainty_.covariances) {
    EXPECT_EQ(covariance, Mat3(kVariance * Mat3::Identity())) << id;
  }
}

// Without it this would be 3.3.
TEST(Jackknife, HoldsErrorsThatNeighboursHaveInCommon) {
  double mean = 0;
  constexpr int kTrials = 6;
  for (int trial = 0; trial < kTrials; ++trial) {
    TestScene test = ChainOfLines(300 + trial);
    AddCommonErrors(0.5, 300 + trial, &test.scene);
    BuildAndAdjust(&test.scene);
    mean += NormalisedCenterError(test) / kTrials;
  }
  EXPECT_GT(mean, 0.3);
  EXPECT_LT(mean, 1.5);
}

// Patches and groups are those of the scene, in whatever world.
TEST(Jackknife, FollowsTheWorld) {
  TestScene test = ChainOfLines(4);
  const Similarity moved = {
      3, RotationFromAngleAxis(Vec3(0.3, -1, 0.5)), {5, -7, 2}};
  Scene other = test::Transformed(test.scene, moved);
  BuildAndAdjust(&test.scene);
  BuildAndAdjust(&other);
  for (const auto& [id, pose] : test.scene.poses) {
    const Mat3 expected = 9 * moved.rotation * *pose.center_covariance *
                          moved.rotation.transpose();
    const Mat3& found = *other.poses.at(id).center_covariance;
    EXPECT_LT((found - expected).norm(), 0.01 * expected.norm()) << id;
  }
}

}  // namespace
}  // namespace lowlap
