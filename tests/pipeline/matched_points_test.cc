// The points of another program, on two of the bundled photographs.
#include "lowlap/pipeline/internal/measure/matched_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "lowlap/features/internal/features.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/pipeline/image_collection.h"
#include "support/data_folder.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing::IsOk;

const ViewPair kPair{0, 1};

class MatchedPointsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    IntrinsicSource intrinsics;
    intrinsics.focal_px = 997.5;
    std::vector<std::string> others;
    for (const char* name :
         {"02", "03", "04", "05", "06", "07", "08", "09", "10"}) {
      others.push_back(std::string("00") + name + ".jpg");
    }
    auto scene = SceneFromImages(RoomFolder() + "/images", intrinsics, others);
    ASSERT_THAT(scene, IsOk());
    FeatureOptions options;
    options.detect_lines = false;
    auto detected = DetectFeatures(*scene, options, {});
    ASSERT_THAT(detected, IsOk());
    auto matches = MatchFeatures(*detected, {kPair}, {}, {});
    ASSERT_THAT(matches, IsOk());
    for (const auto& [view, features] : *detected) {
      scene->features[view].points_px = features.features.points_px;
    }
    scene_ = new Scene(std::move(*scene));
    points_ = new MatchedPoints;
    points_->matches[kPair] = matches->at(kPair).points;
  }
  static void TearDownTestSuite() {
    delete scene_;
    delete points_;
  }

  // The scene with the relative pose of its two views.
  Scene Related(const MatchedPoints& points, PhotographUse use,
                const std::string& root_path = scene_->root_path) {
    Scene scene = *scene_;
    scene.root_path = root_path;
    RunContext context;
    context.log = [this](LogLevel, const std::string& message) {
      log_.push_back(message);
    };
    const auto pairs =
        RelateMatchedPoints(points, use, {}, {}, context, nullptr, &scene);
    EXPECT_THAT(pairs, IsOk());
    EXPECT_EQ(scene.relative_poses.count(kPair), 1u);
    return scene;
  }

  static Scene* scene_;
  static MatchedPoints* points_;
  std::vector<std::string> log_;
};

Scene* MatchedPointsTest::scene_ = nullptr;
MatchedPoints* MatchedPointsTest::points_ = nullptr;

TEST_F(MatchedPointsTest, AddsTheLinesOfThePhotographs) {
  const Scene points = Related(*points_, PhotographUse::kNone);
  EXPECT_TRUE(points.relative_poses.at(kPair).line_inliers.empty());
  EXPECT_TRUE(points.line_tracks.empty());
  EXPECT_FALSE(points.point_tracks.empty());
  const Scene lines = Related(*points_, PhotographUse::kLines);
  EXPECT_FALSE(lines.relative_poses.at(kPair).line_inliers.empty());
  EXPECT_FALSE(lines.line_tracks.empty());
  // Points keep their indices.
  EXPECT_EQ(lines.features.at(0).points_px, points.features.at(0).points_px);
}

TEST_F(MatchedPointsTest, NeedsNoPhotographs) {
  Scene without =
      Related(*points_, PhotographUse::kLinesIfThere, "no such folder");
  EXPECT_THAT(log_, Contains(HasSubstr("no photographs, points alone: ")));
  without.root_path = scene_->root_path;
  EXPECT_TRUE(without == Related(*points_, PhotographUse::kNone));
}

TEST_F(MatchedPointsTest, TakesAPoseThatIsKnown) {
  const RelativePose estimated =
      Related(*points_, PhotographUse::kNone).relative_poses.at(kPair);
  MatchedPoints points = *points_;
  const RigidTransform known{
      RotationFromAngleAxis({0, 1e-3, 0}) * estimated.rotation,
      2 * estimated.direction};
  points.cam2_from_cam1[kPair] = known;
  for (const PhotographUse use :
       {PhotographUse::kNone, PhotographUse::kLines}) {
    const RelativePose pose = Related(points, use).relative_poses.at(kPair);
    EXPECT_EQ(pose.rotation, known.rotation);
    EXPECT_THAT(pose.direction,
                testing::VectorNear(estimated.direction, 1e-12));
    EXPECT_EQ(pose.point_inliers, points.matches.at(kPair));
    EXPECT_EQ(pose.line_inliers.empty(), use == PhotographUse::kNone);
  }
}

}  // namespace
}  // namespace lowlap
