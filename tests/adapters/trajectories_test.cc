// Trajectories of the TUM RGB-D and KITTI odometry benchmarks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "adapters/temporary_folder.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"
#include "third_party_adapters/internal/camera_files.h"
#include "third_party_adapters/scene_formats.h"
#include "third_party_adapters/trajectories/internal/kitti.h"
#include "third_party_adapters/trajectories/internal/tum.h"

namespace lowlap::trajectories {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsError;
using testing::IsOk;
using testing::VectorNear;

// A camera at (1, 2, 3) that looks along the world's x axis.
constexpr char kKittiText[] =
    "1 0 0 0 0 1 0 0 0 0 1 0\n"
    "0 0 1 1 0 1 0 2 -1 0 0 3\n";
constexpr char kTumText[] =
    "# ground truth\n# timestamp tx ty tz qx qy qz qw\n"
    "1305031102.1753 0 0 0 0 0 0 1\n"
    "1305031102.2111 1 2 3 0 0.70710678 0 0.70710678\n";

void ExpectLooksAlongX(const Pose& pose) {
  EXPECT_EQ(pose.center, Vec3(1, 2, 3));
  EXPECT_THAT(Vec3(pose.rotation.row(2)), VectorNear(Vec3(1, 0, 0), 1e-7));
}

TEST(Kitti, LinesAreWorldFromCamera) {
  const auto scene = ParseKitti(kKittiText, "poses.txt");
  ASSERT_THAT(scene, IsOk());
  ASSERT_EQ(scene->views.size(), 2u);
  EXPECT_EQ(scene->views.at(1).filename, "");
  ExpectLooksAlongX(scene->poses.at(1));
}

TEST(Tum, QuaternionsAreWorldFromCameraWithTheRealPartLast) {
  const auto scene = ParseTum(kTumText, "gt.txt");
  ASSERT_THAT(scene, IsOk());
  EXPECT_EQ(scene->views.at(1).filename, "1305031102.2111");
  ExpectLooksAlongX(scene->poses.at(1));
}

TEST(Trajectories, AreToldByTheirFirstLine) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadScene(folder.Write("00.txt", kKittiText))->poses.size(), 2u);
  EXPECT_EQ(ReadScene(folder.Write("gt.txt", kTumText))->poses.size(), 2u);
  // A calibration matrix is neither.
  EXPECT_THAT(ReadScene(folder.Write("K.txt", "500 0 320\n0 500 240\n0 0 1\n")),
              IsError(ErrorCode::kUnsupported, "K.txt"));
}

TEST(Trajectories, AreTrueCamerasOfAScene) {
  const TemporaryFolder folder;
  const Scene scene = testing::RandomScene(1, 2, 5, 0);
  const auto truth = ReadGroundTruth(folder.Write("00.txt", kKittiText), scene);
  ASSERT_THAT(truth, IsOk());
  ExpectLooksAlongX(truth->at(1));
}

TEST(Kitti, WarnsWhereALineIsNotTheIdOfItsView) {
  Scene scene = testing::RandomScene(1, 3, 5, 0);
  SceneNotes notes;
  ASSERT_THAT(FormatKitti(scene, &notes), IsOk());
  EXPECT_THAT(notes, IsEmpty());
  scene.poses.erase(1);
  const auto text = FormatKitti(scene, &notes);
  ASSERT_THAT(text, IsOk());
  EXPECT_THAT(notes, Contains("1 views without a pose were left out"));
  EXPECT_THAT(notes, Contains(HasSubstr("line n of the file is the n-th")));
  EXPECT_EQ(ParseKitti(*text, {})->poses.size(), 2u);
}

TEST(Tum, TimestampsAreFileNamesIfTheseAreNumbers) {
  Scene scene = testing::RandomScene(1, 3, 5, 0);
  scene.views.at(0).filename = "rgb/12.500.png";
  scene.views.at(1).filename = "0013.jpg";
  scene.views.at(2).filename = "14.25";
  SceneNotes notes;
  const Scene back = *ParseTum(*FormatTum(scene, &notes), {});
  EXPECT_EQ(back.views.at(0).filename, "12.500");
  EXPECT_EQ(back.views.at(1).filename, "0013");
  EXPECT_EQ(back.views.at(2).filename, "14.25");
  EXPECT_THAT(notes, IsEmpty());
}

TEST(Tum, TimestampsAreIdsOtherwise) {
  Scene scene = testing::RandomScene(1, 3, 5, 0);
  scene.views[70] = scene.views.at(2);
  scene.views.erase(2);
  scene.relative_poses.clear();
  scene.point_tracks.clear();
  scene.structure.clear();
  scene.scale_ratios.clear();
  scene.features.clear();
  for (const char* name : {"kitchen.jpg", "0.jpg"}) {  // twice 0
    scene.views.at(70).filename = name;
    SceneNotes notes;
    const auto text = FormatTum(scene, &notes);
    ASSERT_THAT(text, IsOk());
    EXPECT_THAT(notes, Contains(HasSubstr("timestamps are the ids")));
    EXPECT_EQ(ParseTum(*text, {})->views.count(70), 1u);
  }
}

TEST(Tum, TimestampsThatAreIdsAreTrueCamerasOfTheScene) {
  const TemporaryFolder folder;
  Scene scene = testing::RandomScene(1, 3, 5, 0);
  for (auto& [id, view] : scene.views) {
    view.filename = "kitchen" + std::to_string(7 - id.value()) + ".jpg";
  }
  const std::string path = folder.Path("scene.tum");
  ASSERT_THAT(WriteScene(scene, path), IsOk());
  const auto truth = ReadGroundTruth(path, scene);
  ASSERT_THAT(truth, IsOk());
  for (const auto& [id, pose] : *truth) {
    EXPECT_EQ(pose.center, scene.FindPose(id)->center);
  }
}

TEST(Kitti, MalformedFilesAreErrorsWithALine) {
  for (const auto& [text, message] :
       std::vector<std::pair<std::string, std::string>>{
           {"", "holds no pose"},
           {"1 0 0 0 0 1 0 0 0 0 1\n", "line 1: the line ends"},
           {"1 0 0 0 0 1 0 0 0 0 1 0 0\n", "line 1: the line goes on"},
           {"1 0 0 0 0 1 0 0 0 0 1 0\n\n2 0 0 0 0 1 0 0 0 0 1 0\n",
            "line 3: the matrix of pose 1 is no rotation"},
           {"1 0 0 nan 0 1 0 0 0 0 1 0\n", "'nan' is not"},
           {"1 0 0 1e999 0 1 0 0 0 0 1 0\n", "'1e999' is not"}}) {
    EXPECT_THAT(ParseKitti(text, "a"), IsError(ErrorCode::kParse, message));
  }
}

TEST(Tum, MalformedFilesAreErrorsWithALine) {
  for (const auto& [text, message] :
       std::vector<std::pair<std::string, std::string>>{
           {"# nothing\n", "holds no pose"},
           {"1 0 0 0 0 0 0\n1 2\n", "line 1: the line ends"},
           {"1 0 0 0 0 0 0 1 5\n", "line 1: the line goes on"},
           {"first 0 0 0 0 0 0 1\n", "'first' is not a timestamp"},
           {"1 0 0 0 0 0 0 0\n", "timestamp 1 is not of length 1"},
           {"1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "line 2: the timestamp 1"},
           {"1 inf 0 0 0 0 0 1\n", "'inf' is not"}}) {
    EXPECT_THAT(ParseTum(text, "a"), IsError(ErrorCode::kParse, message));
  }
}

TEST(Trajectories, EveryTruncationInALineIsAnErrorOfThatLine) {
  for (const char* whole : {kKittiText, kTumText}) {
    const std::string text = whole;
    const std::size_t last_line = text.rfind('\n', text.size() - 2) + 1;
    for (std::size_t n = last_line + 1; n < text.size(); ++n) {
      if (!std::isspace(text[n]) || text[n] == '\n') continue;
      const std::string cut = text.substr(0, n);
      EXPECT_THAT(text[0] == '#' ? ParseTum(cut, "a") : ParseKitti(cut, "a"),
                  IsError(ErrorCode::kParse, "the line ends"));
    }
  }
}

}  // namespace
}  // namespace lowlap::trajectories
