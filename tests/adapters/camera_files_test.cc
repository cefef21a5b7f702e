#include "third_party_adapters/internal/camera_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/temporary_folder.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "tests/support/matchers.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::PoseNear;

constexpr char kCamera[] =
    "900 0 599.5\n0 900 449.5\n0 0 1\n0 0 0\n"
    "1 0 0\n0 1 0\n0 0 1\n1 2 3\n1200 900\n";

Scene TrueRoom() {
  SyntheticOptions options;
  options.num_views = 3;
  return TrueSolution(*Simulate(options));
}

TEST(ReadIntrinsicSource, TakesAMatrixOrAScene) {
  const TemporaryFolder folder;
  const auto matrix = ReadIntrinsicSource(
      folder.Write("K.txt", "900 0 599.5\n0 905 449.5\n0 0 1\n"));
  ASSERT_THAT(matrix, IsOk());
  ASSERT_TRUE(matrix->calibration.has_value());
  EXPECT_EQ((*matrix->calibration)(1, 1), 905);

  const Scene room = TrueRoom();
  ASSERT_THAT(WriteScene(room, folder.Path("room.lowlap")), IsOk());
  const auto scene = ReadIntrinsicSource(folder.Path("room.lowlap"));
  ASSERT_THAT(scene, IsOk());
  ASSERT_TRUE(scene->scene.has_value());
  EXPECT_EQ(scene->scene->intrinsics, room.intrinsics);
}

TEST(ReadIntrinsicSource, TakesAModelOfColmap) {
  const TemporaryFolder folder;
  const Scene room = TrueRoom();
  ASSERT_THAT(WriteScene(room, folder.Path("model"), "colmap"), IsOk());
  const auto source = ReadIntrinsicSource(folder.Path("model"));
  ASSERT_THAT(source, IsOk());
  ASSERT_TRUE(source->scene.has_value());
  EXPECT_EQ(source->scene->intrinsics.begin()->second,
            room.intrinsics.begin()->second);

  // What is wrong with a scene is not that it is no matrix.
  const std::string cameras =
      folder.Write("model/cameras.txt", "1 FOV 1200 900 900 900 600 450 1\n");
  EXPECT_THAT(ReadIntrinsicSource(folder.Path("model")),
              IsError(ErrorCode::kUnsupported, "camera 1 has model FOV"));
}

TEST(ReadIntrinsicSource, NamesAFileThatIsNeither) {
  const TemporaryFolder folder;
  const std::string text = folder.Write("K.txt", "900 0");
  EXPECT_THAT(ReadIntrinsicSource(text), IsError(ErrorCode::kParse, text));
  // A scene that is broken is no matrix.
  const std::string scene = folder.Write("scene.json", "{");
  EXPECT_THAT(ReadIntrinsicSource(scene), IsError(ErrorCode::kParse, scene));
}

TEST(ReadGroundTruth, TakesAFolderOfCamerasByImageName) {
  const TemporaryFolder folder;
  Scene room = TrueRoom();
  folder.Write("gt/" + room.views.at(1).filename + ".camera", kCamera);
  const auto truth = ReadGroundTruth(folder.Path("gt"), room);
  ASSERT_THAT(truth, IsOk());
  ASSERT_EQ(truth->size(), 1u);
  EXPECT_THAT(truth->at(1),
              PoseNear(Pose{Mat3::Identity(), Vec3(1, 2, 3)}, 1e-6, 1e-12));
}

TEST(ReadGroundTruth, TakesASceneFile) {
  const TemporaryFolder folder;
  const Scene room = TrueRoom();
  ASSERT_THAT(WriteScene(room, folder.Path("room.lowlap")), IsOk());
  const auto truth = ReadGroundTruth(folder.Path("room.lowlap"), room);
  ASSERT_THAT(truth, IsOk());
  EXPECT_EQ(truth->size(), room.views.size());
}

TEST(ReadGroundTruth, TakesAModelOfColmapByImageName) {
  const TemporaryFolder folder;
  const Scene room = TrueRoom();
  for (const char* format : {"colmap", "colmap-bin"}) {
    const std::string path = folder.Path(format);
    ASSERT_THAT(WriteScene(room, path, format), IsOk());
    const auto truth = ReadGroundTruth(path, room);
    ASSERT_THAT(truth, IsOk());
    ASSERT_EQ(truth->size(), room.views.size());
    // Though the ids of the model are others.
    EXPECT_THAT(truth->at(1), PoseNear(*room.FindPose(1), 1e-6, 1e-12));
  }
}

TEST(ReadGroundTruth, NamesWhatIsNoTruth) {
  const TemporaryFolder folder;
  const Scene room = TrueRoom();
  EXPECT_THAT(ReadGroundTruth(folder.Path("none"), room),
              IsError(ErrorCode::kNotFound, folder.Path("none")));
  EXPECT_THAT(ReadGroundTruth(folder.Write("gt.txt", "1 2 3"), room),
              IsError(ErrorCode::kUnsupported, "colmap-bin"));
}

TEST(ReadGroundTruth, RefusesATruthAboutOtherViews) {
  const TemporaryFolder folder;
  const Scene room = TrueRoom();
  folder.Write("gt/elsewhere.jpg.camera", kCamera);
  EXPECT_THAT(ReadGroundTruth(folder.Path("gt"), room),
              IsError(ErrorCode::kInsufficientData, folder.Path("gt")));
  Scene unsolved = room;
  unsolved.poses.clear();
  unsolved.structure.clear();
  unsolved.line_structure.clear();
  ASSERT_THAT(WriteScene(unsolved, folder.Path("unsolved.lowlap")), IsOk());
  EXPECT_THAT(ReadGroundTruth(folder.Path("unsolved.lowlap"), room),
              IsError(ErrorCode::kInsufficientData, "holds no camera poses"));
}

}  // namespace
}  // namespace lowlap
