#include "lowlap/averaging/reliability/internal/lost_features.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Scene SceneOfThreeCameras() {
  Scene scene;
  scene.intrinsics[0] = Intrinsic();
  for (const std::uint32_t view : {0u, 1u, 2u}) {
    scene.views[view].intrinsic_id = 0;
    scene.views[view].pose_id = view;
    scene.poses[view] = Pose();
  }
  return scene;
}

TEST(LostFeatures, AViewThatLostItsFeatures) {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "window:3";
  Scene scene = TrueSolution(*Simulate(options));
  EXPECT_THAT(FindLostFeatures(scene), IsEmpty());
  const auto lose = [](ViewId view, auto* observations) {
    observations->erase(
        std::remove_if(observations->begin(), observations->end(),
                       [&](const auto& seen) { return seen.view == view; }),
        observations->end());
  };
  for (auto& entry : scene.structure) lose(3, &entry.second.observations);
  for (auto& entry : scene.line_structure) {
    lose(3, &entry.second.observations);
  }
  const auto warnings = FindLostFeatures(scene);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kLostFeatures);
  EXPECT_THAT(warnings[0].views, ElementsAre(3));
  EXPECT_EQ(warnings[0].share, 0);
  // Where the camera is not known, landmarks cannot have observations.
  scene.views.at(3).intrinsic_id = kInvalidId;
  EXPECT_THAT(FindLostFeatures(scene), IsEmpty());
}

// Two views of a line fit any poses, in however many pieces they see it.
TEST(LostFeatures, PiecesOfALineInTwoViewsAreNotThreeViews) {
  Scene scene = SceneOfThreeCameras();
  scene.line_tracks[0] = {{0, 0}, {0, 1}, {1, 0}, {1, 2}};
  EXPECT_THAT(FindLostFeatures(scene), IsEmpty());
  scene.line_tracks[0].push_back({2, 0});
  EXPECT_EQ(FindLostFeatures(scene).size(), 3u);
}

// A line in pieces is one feature of its view, and is lost or kept as one.
TEST(LostFeatures, PiecesOfALineCountOnce) {
  Scene scene = SceneOfThreeCameras();
  // Lost, in five pieces; the other two fit.
  scene.line_tracks[0] = {{0, 0}, {0, 1}, {0, 2}, {0, 3},
                          {0, 4}, {1, 0}, {2, 0}};
  for (const std::uint32_t id : {1u, 2u}) {
    scene.line_tracks[id] = {{0, id + 4}, {1, id}, {2, id}};
    scene.line_structure[id].observations = scene.line_tracks[id];
  }
  EXPECT_THAT(FindLostFeatures(scene), IsEmpty());
}

}  // namespace
}  // namespace lowlap
