#include "lowlap/scene/internal/view_names.h"

#include <gtest/gtest.h>

#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;

Scene SceneWith(const std::map<ViewId, std::string>& names) {
  Scene scene;
  for (const auto& [id, name] : names) scene.views[id].filename = name;
  return scene;
}

TEST(ViewNames, NamesComeBeforeIds) {
  const ViewNames names(
      SceneWith({{1, "left/a.jpg"}, {2, "b.jpg"}, {5, "2.png"}}));
  EXPECT_EQ(*names.Find("left/a.jpg"), 1u);
  EXPECT_EQ(*names.Find("a.jpg"), 1u);
  EXPECT_EQ(*names.Find("a"), 1u);
  EXPECT_EQ(*names.Find("2"), 5u);
  EXPECT_EQ(*names.Find("1"), 1u);
  for (const char* word : {"", "c", "01", "7", "-1", "left"}) {
    EXPECT_THAT(names.Find(word),
                IsError(ErrorCode::kInvalidArgument, "no view"))
        << word;
  }
}

TEST(ViewNames, NumbersThatNameAllViewsAreNeverIds) {
  // As after leaving out 0000.jpg: ids are one behind the names.
  const ViewNames names(SceneWith({{0, "0001.jpg"}, {1, "0002.jpg"}}));
  EXPECT_EQ(*names.Find("0001"), 0u);
  EXPECT_EQ(*names.Find("1"), 0u);
  EXPECT_EQ(*names.Find("2"), 1u);
  EXPECT_THAT(names.Find("0"), IsError(ErrorCode::kInvalidArgument, "\"0\""));
  EXPECT_THAT(names.Find("0000"),
              IsError(ErrorCode::kInvalidArgument, "no view"));
}

TEST(ViewNames, PathsTellViewsOfOneFileNameApart) {
  Scene scene = SceneWith({{0, "0001.jpg"}, {1, "0001.jpg"}});
  scene.views.at(0).local_path = "left";
  scene.views.at(1).local_path = "right/";
  const ViewNames names(scene);
  EXPECT_EQ(*names.Find("left/0001.jpg"), 0u);
  EXPECT_EQ(*names.Find("right/0001.jpg"), 1u);
  EXPECT_THAT(names.Find("0001.jpg"),
              IsError(ErrorCode::kInvalidArgument, "several views"));
}

TEST(ViewNames, AWordThatSeveralViewsFitIsRefused) {
  const ViewNames names(SceneWith(
      {{0, "a.jpg"}, {1, "a.png"}, {2, "left/b.jpg"}, {3, "right/b.jpg"}}));
  EXPECT_EQ(*names.Find("a.png"), 1u);
  EXPECT_EQ(*names.Find("right/b.jpg"), 3u);
  for (const char* word : {"a", "b", "b.jpg"}) {
    EXPECT_THAT(names.Find(word),
                IsError(ErrorCode::kInvalidArgument, "several views"))
        << word;
  }
}

TEST(ViewNames, TheRefusalSaysHowToNameEach) {
  const auto why = [](const Scene& scene, const char* word) {
    return ViewNames(scene).Find(word).error().message;
  };
  Scene scene = SceneWith({{0, "b.jpg"}, {1, "b.jpg"}, {7, "c.jpg"}});
  scene.views.at(0).local_path = "left";
  scene.views.at(1).local_path = "right";
  EXPECT_EQ(why(scene, "b.jpg"),
            "several views are named \"b.jpg\": left/b.jpg, right/b.jpg; use "
            "one of these names");
  // A longer name would not help.
  scene.views.at(0).local_path = "right";
  EXPECT_EQ(why(scene, "right/b.jpg"),
            "several views are named \"right/b.jpg\": nothing tells them apart "
            "but their ids, 0, 1");
  scene = Scene();
  for (std::uint32_t id = 0; id < 9; ++id) {
    scene.views[id].local_path = std::to_string(id);
    scene.views[id].filename = "a.jpg";
  }
  EXPECT_EQ(why(scene, "a"),
            "several views are named \"a\": 0/a.jpg, 1/a.jpg, 2/a.jpg, "
            "3/a.jpg, ...; use one of these names");
}

}  // namespace
}  // namespace lowlap
