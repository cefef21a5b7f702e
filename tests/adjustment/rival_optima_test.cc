#include "lowlap/adjustment/internal/uncertainty/rival_optima.h"

#include <gmock/gmock.h>

#include <iterator>

#include "lowlap/adjustment/internal/uncertainty/center_shift.h"
#include "lowlap/geometry/internal/rotation.h"
#include "test_scene.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;
using ::testing::Not;
using ::testing::SizeIs;

// An adjusted scene, and what is known of its centres: each to 1 cm.
class RivalOptimaTest : public ::testing::Test {
 protected:
  RivalOptimaTest() : scene_(Adjusted()), cameras_(scene_), state_(State()) {
    for (const auto& [id, pose] : scene_.poses) {
      uncertainty_.covariances[id] = 1e-4 * Mat3::Identity();
    }
    const auto first = scene_.views.begin();
    triplet_ = {first->first, std::next(first)->first,
                std::next(first, 2)->first};
    uncertainty_.log_ratio_stddevs[triplet_] = 0.01;
  }

  static Scene Adjusted() {
    test::TestScene test = test::MakeTestScene({});
    test::BuildAndAdjust(&test.scene);
    return test.scene;
  }
  StructureState State() const {
    StructureState state;
    state.points = LoadPoints(scene_, cameras_);
    state.lines = LoadLines(scene_, cameras_, false);
    return state;
  }

  /// In a world of its own, with the second centre elsewhere by `distance`.
  Rival Moved(double distance) const {
    CameraSet cameras = cameras_;
    cameras.poses[1].center += distance * Vec3(0, 0, 1);
    const Mat3 turn = RotationFromAngleAxis(Vec3(0.4, -1, 0.7));
    for (PoseState& pose : cameras.poses) {
      pose.center = 3 * (turn * pose.center) + Vec3(1, 2, 3);
    }
    return {"lines first", cameras};
  }

  std::vector<RivalOptimum> Add(const std::vector<Rival>& rivals) {
    return AddRivals({}, rivals, cameras_, state_, &uncertainty_);
  }

  Scene scene_;
  CameraSet cameras_;
  StructureState state_;
  ViewTriplet triplet_;
  CenterUncertainty uncertainty_;
};

TEST_F(RivalOptimaTest, NamesWhatIsElsewhereAndWidensTheDeviations) {
  const std::vector<RivalOptimum> rivals = Add({Moved(0.05)});
  ASSERT_THAT(rivals, SizeIs(1));
  EXPECT_EQ(rivals[0].start, "lines first");
  const PoseId moved = cameras_.poses[1].id;
  ASSERT_THAT(rivals[0].distances, ElementsAre(Key(moved)));
  // The similarity takes a part of it.
  const double distance = rivals[0].distances.at(moved);
  EXPECT_GT(distance, 0.028);
  EXPECT_LT(distance, 0.05);
  EXPECT_NEAR(uncertainty_.covariances.at(moved)(0, 0),
              1e-4 + distance * distance / 3, 1e-9);
  EXPECT_GT(uncertainty_.log_ratio_stddevs.at(triplet_), 0.011);
}

TEST_F(RivalOptimaTest, WhatIsWithinTheDeviationsIsTheSameOptimum) {
  const CenterUncertainty before = uncertainty_;
  EXPECT_THAT(Add({Moved(0.01), Moved(0)}), IsEmpty());
  EXPECT_EQ(uncertainty_.covariances, before.covariances);
  EXPECT_EQ(uncertainty_.log_ratio_stddevs, before.log_ratio_stddevs);
}

TEST_F(RivalOptimaTest, WithoutRivalsNothingChanges) {
  const CenterUncertainty before = uncertainty_;
  EXPECT_THAT(Add({}), IsEmpty());
  EXPECT_EQ(uncertainty_.covariances, before.covariances);
}

TEST_F(RivalOptimaTest, TheSentenceNamesTheViews) {
  AdjustmentSummary summary;
  EXPECT_THAT(DescribeRivals(scene_, summary), IsEmpty());
  summary.rivals = {{"lines first", {{cameras_.poses[1].id, 0.0625}}}};
  const std::vector<std::string> sentences = DescribeRivals(scene_, summary);
  ASSERT_THAT(sentences, SizeIs(1));
  EXPECT_THAT(sentences[0], HasSubstr("(lines first)"));
  EXPECT_THAT(sentences[0], HasSubstr("up to 0.0625"));
  EXPECT_THAT(sentences[0], HasSubstr("1.png"));
  EXPECT_THAT(sentences[0], Not(HasSubstr("0.png")));
}

}  // namespace
}  // namespace lowlap
