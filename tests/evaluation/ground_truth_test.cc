#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/evaluation/pose_errors.h"

namespace lowlap {
namespace {

Pose PoseAt(double x) {
  Pose pose;
  pose.center.x() = x;
  return pose;
}

Scene SceneOf(const std::vector<std::pair<std::string, std::string>>& files) {
  Scene scene;
  for (std::size_t n = 0; n < files.size(); ++n) {
    View& view = scene.views[static_cast<ViewId>(n)];
    view.local_path = files[n].first;
    view.filename = files[n].second;
  }
  return scene;
}

TEST(GroundTruthByName, MatchesPathThenNameThenStem) {
  const Scene scene = SceneOf({{"left", "1.jpg"},
                               {"right", "1.jpg"},
                               {"left", "2.jpg"},
                               {"", "3.png"},
                               {"", "4.jpg"}});
  const auto truth = GroundTruthByName(scene, {{"left/1.jpg", PoseAt(1)},
                                               {"right/1.jpg", PoseAt(2)},
                                               {"2.jpg", PoseAt(3)},
                                               {"3.jpg", PoseAt(4)},
                                               {"5.jpg", PoseAt(5)}});
  ASSERT_TRUE(truth.has_value()) << truth.error().ToString();
  ASSERT_EQ(truth->size(), 4u);
  EXPECT_EQ(truth->at(0).center.x(), 1);
  EXPECT_EQ(truth->at(1).center.x(), 2);
  EXPECT_EQ(truth->at(2).center.x(), 3);
  EXPECT_EQ(truth->at(3).center.x(), 4);
}

TEST(GroundTruthByName, AnExactNameIsNotTakenByALooseOne) {
  const Scene scene = SceneOf({{"", "1.png"}, {"", "1.jpg"}});
  const auto truth = GroundTruthByName(scene, {{"1.jpg", PoseAt(1)}});
  ASSERT_TRUE(truth.has_value());
  EXPECT_EQ(truth->count(0), 0u);
  EXPECT_EQ(truth->count(1), 1u);
}

TEST(GroundTruthByName, FoldersOfEitherSideNeedNotMatch) {
  const Scene scene =
      SceneOf({{"", "1.jpg"}, {"photographs", "2.png"}, {"", "3.jpg"}});
  const auto truth = GroundTruthByName(scene, {{"images/1.jpg", PoseAt(1)},
                                               {"images/2.jpg", PoseAt(2)},
                                               {"left/3.jpg", PoseAt(3)},
                                               {"right/3.jpg", PoseAt(4)}});
  ASSERT_TRUE(truth.has_value()) << truth.error().ToString();
  ASSERT_EQ(truth->size(), 2u);
  EXPECT_EQ(truth->at(0).center.x(), 1);
  EXPECT_EQ(truth->at(1).center.x(), 2);
}

TEST(GroundTruthByName, FoldersTellImagesApartWhereAnyMatches) {
  const Scene scene = SceneOf({{"left", "1.jpg"}, {"right", "2.jpg"}});
  const auto truth = GroundTruthByName(
      scene, {{"left/1.jpg", PoseAt(1)}, {"left/2.jpg", PoseAt(2)}});
  ASSERT_TRUE(truth.has_value());
  EXPECT_EQ(truth->count(0), 1u);
  EXPECT_EQ(truth->count(1), 0u);
}

TEST(GroundTruthByName, TimestampsHaveNoExtension) {
  const Scene scene = SceneOf({{"", "17.25.png"}, {"", "17.50.png"}});
  const auto truth =
      GroundTruthByName(scene, {{"17.25", PoseAt(1)}, {"17.50", PoseAt(2)}});
  ASSERT_TRUE(truth.has_value()) << truth.error().ToString();
  ASSERT_EQ(truth->size(), 2u);
  EXPECT_EQ(truth->at(0).center.x(), 1);
  EXPECT_EQ(truth->at(1).center.x(), 2);
  // Nor is another moment of the same second the same.
  EXPECT_FALSE(GroundTruthByName(scene, {{"17.75", PoseAt(3)}}).has_value());
}

TEST(GroundTruthByName, TwoTruthsOfOneStemAreNotGuessedAt) {
  const Scene scene = SceneOf({{"", "1.tif"}, {"", "2.jpg"}});
  const auto truth = GroundTruthByName(
      scene,
      {{"1.jpg", PoseAt(1)}, {"1.png", PoseAt(2)}, {"2.jpg", PoseAt(3)}});
  ASSERT_TRUE(truth.has_value());
  EXPECT_EQ(truth->count(0), 0u);
  EXPECT_EQ(truth->count(1), 1u);
}

TEST(GroundTruthByName, AmbiguityAndNoMatchAreErrors) {
  const Scene scene = SceneOf({{"left", "1.jpg"}, {"right", "1.jpg"}});
  const auto ambiguous = GroundTruthByName(scene, {{"1.jpg", PoseAt(1)}});
  ASSERT_FALSE(ambiguous.has_value());
  EXPECT_EQ(ambiguous.error().code, ErrorCode::kInvalidScene);
  EXPECT_THAT(ambiguous.error().message, ::testing::HasSubstr("'1.jpg'"));
  const auto none = GroundTruthByName(scene, {{"7.jpg", PoseAt(1)}});
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, ErrorCode::kInsufficientData);
}

TEST(GroundTruthFromScene, TakesThePosedViewsWithSharedPoses) {
  Scene scene = SceneOf({{"", "a"}, {"", "b"}, {"", "c"}});
  scene.views.at(0).pose_id = 9;
  scene.views.at(1).pose_id = 9;
  scene.views.at(2).pose_id = 4;
  scene.poses[9] = PoseAt(5);
  const GroundTruth truth = GroundTruthFromScene(scene);
  ASSERT_EQ(truth.size(), 2u);
  EXPECT_EQ(truth.at(1).center.x(), 5);
}

/// The center of each view's pose has the view's id as its x.
void PoseEveryView(Scene* scene) {
  for (auto& [id, view] : scene->views) {
    view.pose_id = id.value();
    scene->poses[view.pose_id] = PoseAt(id.value());
  }
}

TEST(GroundTruthFromScene, GoesByNameWhereNamesTell) {
  const Scene scene = SceneOf({{"", "b.jpg"}, {"", "a.jpg"}});
  Scene truth = SceneOf({{"", "a.jpg"}, {"", "b.jpg"}, {"", "c.jpg"}});
  PoseEveryView(&truth);
  const auto by_name = GroundTruthFromScene(truth, scene);
  ASSERT_TRUE(by_name.has_value());
  ASSERT_EQ(by_name->size(), 2u);
  EXPECT_EQ(by_name->at(0).center.x(), 1);
  EXPECT_EQ(by_name->at(1).center.x(), 0);
}

TEST(GroundTruthFromScene, DoesNotGuessWhichOfTwoViewsIsMeant) {
  const Scene scene = SceneOf({{"left", "1.jpg"}, {"right", "1.jpg"}});
  Scene truth = SceneOf({{"", "1.jpg"}, {"", "2.jpg"}});
  PoseEveryView(&truth);
  const auto ambiguous = GroundTruthFromScene(truth, scene);
  ASSERT_FALSE(ambiguous.has_value());
  EXPECT_EQ(ambiguous.error().code, ErrorCode::kInvalidScene);
}

TEST(GroundTruthFromScene, GoesByIdWhereNamesDoNotTell) {
  const Scene scene = SceneOf({{"", "b.jpg"}, {"", "a.jpg"}});
  Scene truth = SceneOf({{"", "a.jpg"}, {"", "a.jpg"}});
  PoseEveryView(&truth);
  const auto by_id = GroundTruthFromScene(truth, scene);
  ASSERT_TRUE(by_id.has_value());
  ASSERT_EQ(by_id->size(), 2u);
  EXPECT_EQ(by_id->at(0).center.x(), 0);
}

TEST(GroundTruthByName, SaysWhichNameSeveralTruthsShare) {
  const Scene scene = SceneOf({{"", "a.jpg"}, {"", "b.jpg"}});
  const auto truth =
      GroundTruthByName(scene, {{"left/a.jpg", {}}, {"right/a.jpg", {}}});
  ASSERT_FALSE(truth.has_value());
  EXPECT_NE(truth.error().message.find("called 'a.jpg'"), std::string::npos);
}

// Other programs count views from one, or in another order.
TEST(GroundTruthFromScene, DoesNotGoByIdAgainstNames) {
  const Scene scene = SceneOf({{"", "b.jpg"}, {"", "a.jpg"}});
  Scene truth = SceneOf({{"", "c.jpg"}, {"", "d.jpg"}});
  PoseEveryView(&truth);
  const auto other = GroundTruthFromScene(truth, scene);
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().code, ErrorCode::kInsufficientData);
}

// Trajectories whose timestamps stand for ids.
TEST(GroundTruthFromScene, GoesByIdWhereNamesAreBothNoMatchAndIds) {
  const Scene scene = SceneOf({{"", "b.jpg"}, {"", "a.jpg"}, {"", "c.jpg"}});
  Scene truth = SceneOf({{"", "0"}, {"", "1"}});
  PoseEveryView(&truth);
  const auto by_id = GroundTruthFromScene(truth, scene);
  ASSERT_TRUE(by_id.has_value()) << by_id.error().ToString();
  ASSERT_EQ(by_id->size(), 2u);
  EXPECT_EQ(by_id->at(1).center.x(), 1);
  // As in a trajectory of photographs 0000.jpg, 0001.jpg.
  truth.views.at(0).filename = "0000";
  truth.views.at(1).filename = "0001";
  EXPECT_EQ(GroundTruthFromScene(truth, scene).value(), *by_id);
  truth.views.at(0).filename = "0";
  truth.views.at(1).filename = "1";
  // Names that match come first.
  const auto by_name =
      GroundTruthFromScene(truth, SceneOf({{"", "1.jpg"}, {"", "0.jpg"}}));
  ASSERT_TRUE(by_name.has_value());
  EXPECT_EQ(by_name->at(0).center.x(), 1);
}

// A list of poses counts from zero, COLMAP from one.
TEST(GroundTruthFromScene, GoesByTheNumbersOfFilesWhereTheyFindMore) {
  Scene truth = SceneOf({{"", ""}, {"", ""}, {"", ""}});
  PoseEveryView(&truth);
  Scene scene;
  for (const std::uint32_t id : {1, 2, 3}) {
    scene.views[id].filename = "frame_00" + std::to_string(id - 1) + ".png";
  }
  const auto by_number = GroundTruthFromScene(truth, scene);
  ASSERT_TRUE(by_number.has_value()) << by_number.error().ToString();
  ASSERT_EQ(by_number->size(), 3u);
  EXPECT_EQ(by_number->at(1).center.x(), 0);
  EXPECT_EQ(by_number->at(3).center.x(), 2);
}

TEST(GroundTruthFromScene, DoesNotChooseBetweenIdsAndNumbers) {
  Scene truth = SceneOf({{"", ""}, {"", ""}, {"", ""}});
  PoseEveryView(&truth);
  const auto both =
      GroundTruthFromScene(truth, SceneOf({{"", "1.jpg"}, {"", "2.jpg"}}));
  ASSERT_FALSE(both.has_value());
  EXPECT_EQ(both.error().code, ErrorCode::kInvalidScene);
  EXPECT_NE(both.error().message.find("view 0 is '1.jpg'"), std::string::npos);
  // Where they agree there is nothing to choose.
  const auto same =
      GroundTruthFromScene(truth, SceneOf({{"", "0.jpg"}, {"", "1.jpg"}}));
  ASSERT_TRUE(same.has_value());
  EXPECT_EQ(same->size(), 2u);
}

TEST(Summarize, GivesMeanMedianMaxAndRmse) {
  EXPECT_EQ(Summarize({}).count, 0);
  EXPECT_EQ(Summarize({}).mean, 0);
  const ErrorStatistics odd = Summarize({4, 1, 1});
  EXPECT_EQ(odd.count, 3);
  EXPECT_EQ(odd.mean, 2);
  EXPECT_EQ(odd.median, 1);
  EXPECT_EQ(odd.max, 4);
  EXPECT_DOUBLE_EQ(odd.rmse, std::sqrt(6.0));
  EXPECT_EQ(Summarize({4, 1, 2, 1}).median, 1.5);
  EXPECT_EQ(Summarize({7}).median, 7);
}

}  // namespace
}  // namespace lowlap
