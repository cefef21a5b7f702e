// Scenes in COLMAP's forms: the two of a model side by side, and databases.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>

#include "adapters/colmap_database.h"
#include "adapters/temporary_folder.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::colmap {
namespace {

using testing::IsError;
using testing::IsOk;

/// View 1 is called `name`, and is image 2 of COLMAP.
Scene SceneWithName(const std::string& name) {
  Scene scene = testing::RandomScene(2, 3, 10, 12);
  scene.views.at(1).filename = name;
  return scene;
}

class ColmapSceneFormat : public ::testing::Test {
 protected:
  std::string Path() const { return folder_.Path("model"); }

  std::string NameIn(const std::string& format) const {
    const Result<Scene> scene = ReadScene(Path(), nullptr, format);
    EXPECT_THAT(scene, IsOk());
    return scene ? scene->views.at(2).filename : std::string();
  }

  const TemporaryFolder folder_;
};

TEST_F(ColmapSceneFormat, OfTwoFormsTheNamedOneIsReadElseTheBinaryOne) {
  ASSERT_THAT(WriteScene(SceneWithName("text.jpg"), Path(), "colmap"), IsOk());
  EXPECT_EQ(NameIn(""), "text.jpg");
  ASSERT_THAT(WriteScene(SceneWithName("binary.jpg"), Path(), "colmap-bin"),
              IsOk());
  EXPECT_EQ(NameIn("colmap"), "text.jpg");
  EXPECT_EQ(NameIn("colmap-bin"), "binary.jpg");
  EXPECT_EQ(NameIn(""), "binary.jpg");
}

TEST_F(ColmapSceneFormat, AnIntrinsicThatIsRefusedHasTheIdOfTheScene) {
  Scene scene = SceneWithName("a.jpg");  // ids from 0, in COLMAP from 1
  Intrinsic& panorama = scene.intrinsics.begin()->second;
  panorama = Intrinsic();
  panorama.model = CameraModel::kSpherical;
  panorama.width_px = 800;
  panorama.height_px = 600;
  const auto refused = WriteScene(scene, Path(), "colmap-bin");
  ASSERT_THAT(refused, IsError(ErrorCode::kUnsupported, "panorama"));
  EXPECT_EQ(refused.error().place, "intrinsic 0");
}

TEST_F(ColmapSceneFormat, APoseOfLinesAloneGoesIntoADatabaseAndComesOut) {
  const std::string path = folder_.Path("database.db");
  {
    ColmapDatabase file(path, ColmapDatabase::Version::k3_8);
    file.AddCamera(1, 1, 800, 600, {500, 510, 400, 300});
    for (const int id : {1, 2, 3}) {
      file.AddImage(id, std::to_string(id) + ".jpg", 1, {10.5F, 20.25F}, 2);
    }
    file.AddMatches(2, 3, {0, 0});
  }
  auto scene = ReadScene(path);
  ASSERT_THAT(scene, IsOk());
  RelativePose& pose = scene->relative_poses[{1, 2}];
  pose.views = {1, 2};
  pose.direction = Vec3::UnitX();
  ASSERT_THAT(WriteScene(*scene, path, "colmap-db"), IsOk());
  SceneNotes notes;
  const auto back = ReadScene(path, &notes);
  ASSERT_THAT(back, IsOk());
  ASSERT_EQ(back->relative_poses.count({1, 2}), 1u);
  EXPECT_LT((back->relative_poses.at({1, 2}).direction - Vec3::UnitX()).norm(),
            1e-15);
  EXPECT_THAT(notes, ::testing::ElementsAre(
                         ::testing::HasSubstr("matches of 1 pairs without")));
}

TEST_F(ColmapSceneFormat, WhatADatabaseCannotHoldOfARelativePoseIsCounted) {
  const std::string path = folder_.Path("database.db");
  {
    ColmapDatabase file(path, ColmapDatabase::Version::k3_8);
    file.AddCamera(1, 1, 800, 600, {500, 510, 400, 300});
    for (const int id : {1, 2}) {
      file.AddImage(id, std::to_string(id) + ".jpg", 1, {10.5F, 20.25F}, 2);
    }
  }
  auto scene = ReadScene(path);
  ASSERT_THAT(scene, IsOk());
  scene->root_path = "images";
  scene->features.begin()->second.repeated_points = {0};
  RelativePose& pose = scene->relative_poses[{1, 2}];
  pose.views = {1, 2};
  EXPECT_THAT(WriteScene(*scene, path, "colmap-db").value(),
              ::testing::ElementsAre(
                  "colmap-db cannot hold 1 image folder, 1 marks of features "
                  "that repeat: left out"));
  pose.log10_nfa = -20;
  pose.covariance = Eigen::Matrix<double, 5, 5>::Identity();
  pose.alternatives.resize(2);
  pose.weakness = PoseWeakness::kRepeats;
  EXPECT_THAT(WriteScene(*scene, path, "colmap-db").value(),
              ::testing::ElementsAre(::testing::HasSubstr(
                  "1 NFAs of relative poses, 1 weaknesses of relative poses, 1 "
                  "covariances of relative poses, 2 alternatives of relative "
                  "poses: left out")));
}

TEST_F(ColmapSceneFormat, AFolderWithoutTheNamedFormIsAnErrorWithTheFile) {
  const auto expect_none = [&](const char* written, const char* missing) {
    const std::string path = folder_.Path(written);
    ASSERT_THAT(WriteScene(SceneWithName("a.jpg"), path, written), IsOk());
    for (const std::string form : {"colmap", "colmap-bin"}) {
      if (form == written) continue;
      EXPECT_THAT(ReadScene(path, nullptr, form),
                  IsError(ErrorCode::kNotFound, missing));
    }
  };
  expect_none("colmap", "cameras.bin");
  expect_none("colmap-bin", "cameras.txt");
  // One that is not complete does not count as there.
  std::filesystem::copy_file(folder_.Path("colmap-bin/cameras.bin"),
                             folder_.Path("colmap/cameras.bin"));
  EXPECT_THAT(ReadScene(folder_.Path("colmap")), IsOk());
  EXPECT_THAT(ReadScene(folder_.Path("colmap"), nullptr, "colmap-bin"),
              IsError(ErrorCode::kNotFound, "images.bin"));
}

TEST_F(ColmapSceneFormat, TextBesideABinaryModelIsRefused) {
  const Scene scene = SceneWithName("a.jpg");
  ASSERT_THAT(WriteScene(scene, Path(), "colmap-bin"), IsOk());
  EXPECT_THAT(WriteScene(scene, Path(), "colmap"),
              IsError(ErrorCode::kInvalidArgument, "binary model"));
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("model/images.txt")));
}

TEST_F(ColmapSceneFormat, NamesThatTextCannotHoldAreRefused) {
  for (const auto& [end, what] : {std::pair(' ', "'a b.jpg' has a blank"),
                                  {'\t', "has a blank"},
                                  {'\n', "'a\\x0Ab.jpg' has a line end"},
                                  {'\r', "has a line end"},
                                  {'\0', "'a\\x00b.jpg' has a NUL"}}) {
    const std::string name = std::string("a") + end + "b.jpg";
    const auto written = WriteScene(SceneWithName(name), Path(), "colmap");
    EXPECT_THAT(written, IsError(ErrorCode::kUnsupported, what));
    EXPECT_THAT(written, IsError(ErrorCode::kUnsupported,
                                 "images.txt: image 2: the name"));
    EXPECT_FALSE(std::filesystem::exists(Path()));
  }
  // The folder belongs to the name.
  Scene scene = SceneWithName("b.jpg");
  scene.views.at(1).local_path = "my photographs";
  EXPECT_THAT(WriteScene(scene, Path(), "colmap"),
              IsError(ErrorCode::kUnsupported, "'my photographs/b.jpg'"));
}

TEST_F(ColmapSceneFormat, BinaryNamesHoldAllButNul) {
  const std::string name = "a b\t\r\nc.jpg";
  ASSERT_THAT(WriteScene(SceneWithName(name), Path(), "colmap-bin"), IsOk());
  EXPECT_EQ(NameIn("colmap-bin"), name);
  const std::string nul("a\0b.jpg", 7);
  EXPECT_THAT(WriteScene(SceneWithName(nul), Path(), "colmap-bin"),
              IsError(ErrorCode::kUnsupported,
                      "images.bin: image 2: the name "
                      "'a\\x00b.jpg' has a NUL"));
  EXPECT_EQ(NameIn("colmap-bin"), name);  // as before
}

TEST_F(ColmapSceneFormat, NamesOfViewsThatAreLeftOutDoNotMatter) {
  Scene scene = SceneWithName("not written.jpg");
  scene.poses.erase(scene.views.at(1).pose_id);
  EXPECT_THAT(WriteScene(scene, Path(), "colmap"), IsOk());
}

}  // namespace
}  // namespace lowlap::colmap
