#include "lowlap/pipeline/internal/measure/relate_and_refine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsError;
using testing::IsOk;

constexpr double kFocalFactor = 1.05;

// A room whose photographs have a focal length that is 5 % too long, without
// relative poses.
class RelateAndRefineTest : public ::testing::Test {
 protected:
  RelateAndRefineTest() {
    SyntheticOptions options;
    options.num_views = 8;
    options.noise_px = 0.3;
    options.pairs = "all";
    measured_ = Simulate(options)->scene;
    scene_ = measured_;
    for (auto& [id, intrinsic] : scene_.intrinsics) {
      intrinsic.fx_px *= kFocalFactor;
      intrinsic.fy_px *= kFocalFactor;
    }
    scene_.relative_poses.clear();
    given_ = scene_.intrinsics;
  }

  Result<std::vector<PairReport>> Relate(const FirstSolution& first) {
    const auto relate = [this](Scene* scene) {
      focals_px_.push_back(scene->intrinsics.begin()->second.fx_px);
      scene->relative_poses = measured_.relative_poses;
      return Result<std::vector<PairReport>>(std::vector<PairReport>(2));
    };
    RunContext context;
    context.log = [this](LogLevel level, const std::string& message) {
      if (level == LogLevel::kWarning) warnings_ += message + '\n';
    };
    return RelateAndRefine(relate, first, context, nullptr, &scene_);
  }

  Scene measured_;
  Scene scene_;
  std::map<IntrinsicId, Intrinsic> given_;
  std::vector<double> focals_px_;  // with which views were related
  std::string warnings_;
};

TEST_F(RelateAndRefineTest, RelatesOnceMoreWithWhatAFirstSolutionRefines) {
  const double true_px = measured_.intrinsics.begin()->second.fx_px;
  FirstSolution first;
  first.refinement.focal = true;
  const auto reports = Relate(first);
  ASSERT_THAT(reports, IsOk());
  EXPECT_EQ(reports->size(), 2u);
  ASSERT_EQ(focals_px_.size(), 2u);
  EXPECT_DOUBLE_EQ(focals_px_[0], kFocalFactor * true_px);
  EXPECT_NEAR(focals_px_[1], true_px, 0.01 * true_px);
  EXPECT_EQ(scene_.intrinsics.begin()->second.fx_px, focals_px_[1]);
  EXPECT_THAT(scene_.poses, IsEmpty());
}

// Relative poses of one focal length are wrong with another: what solves the
// scene again must not go back to the one that was given.
TEST_F(RelateAndRefineTest, ItsMeasurementsAreOfTheIntrinsicsItLeaves) {
  FirstSolution first;
  first.refinement.focal = true;
  ASSERT_THAT(Relate(first), IsOk());
  const auto related = scene_.intrinsics;
  SolveOptions options;
  RefineAllIntrinsics(first.refinement, &scene_, &options.adjustment);
  ASSERT_THAT(SolveScene(&scene_, options, {}, nullptr), IsOk());
  EXPECT_NE(scene_.intrinsics, related);
  RestoreGivenIntrinsics(&scene_);
  EXPECT_EQ(scene_.intrinsics, related);
}

TEST_F(RelateAndRefineTest, HoldsIntrinsicsThatAreNotToBeRefined) {
  ASSERT_THAT(Relate({}), IsOk());
  EXPECT_EQ(focals_px_.size(), 1u);
  EXPECT_EQ(scene_.intrinsics, given_);
  EXPECT_THAT(scene_.given_intrinsics, IsEmpty());
}

TEST_F(RelateAndRefineTest, WithoutASolutionNothingChanges) {
  measured_.relative_poses.clear();
  FirstSolution first;
  first.refinement.focal = true;
  ASSERT_THAT(Relate(first), IsOk());
  EXPECT_THAT(warnings_, HasSubstr("intrinsics not refined before the rest: "));
  EXPECT_EQ(focals_px_.size(), 1u);
  EXPECT_EQ(scene_.intrinsics, given_);
}

TEST_F(RelateAndRefineTest, PassesErrorsOn) {
  const auto fail = [](Scene*) -> Result<std::vector<PairReport>> {
    return MakeError(ErrorCode::kCancelled, "cancelled");
  };
  EXPECT_THAT(RelateAndRefine(fail, {}, {}, nullptr, &scene_),
              IsError(ErrorCode::kCancelled, "cancelled"));
}

}  // namespace
}  // namespace lowlap
