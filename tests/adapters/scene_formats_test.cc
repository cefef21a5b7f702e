#include "third_party_adapters/scene_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "adapters/openmvg_vectors.h"
#include "adapters/temporary_folder.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "support/matchers.h"
#include "third_party_adapters/openmvg/internal/prepare.h"
#include "third_party_adapters/openmvg/internal/sfm_data_bin.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsError;
using testing::IsOk;

Scene TwoViews() {
  return *openmvg::ParseSfmDataBin(openmvg::FromHex(openmvg::kTwoViewsHex));
}

TEST(SceneFormats, EveryReadableFormatKeepsAScene) {
  const TemporaryFolder folder;
  for (const char* name : {"a.json", "a.lowlap", "a.bin", "a.xml", "A.BIN"}) {
    const auto notes = WriteScene(TwoViews(), folder.Path(name));
    ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
    EXPECT_THAT(*notes, IsEmpty());
    const Result<Scene> scene = ReadScene(folder.Path(name));
    ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
    EXPECT_TRUE(*scene == TwoViews()) << name;
  }
}

TEST(SceneFormats, AnSfmDataFileIsToldByItsContent) {
  const TemporaryFolder folder;
  for (const char* format :
       {"json", "openmvg-json", "openmvg-bin", "openmvg-xml"}) {
    for (const char* name : {"a", "a.json", "a.bin", "a.xml"}) {
      ASSERT_TRUE(WriteScene(TwoViews(), folder.Path(name), format));
      const Result<Scene> scene = ReadScene(folder.Path(name));
      ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
      EXPECT_TRUE(*scene == TwoViews()) << format << " " << name;
    }
  }
}

TEST(SceneFormats, ASceneIsToldWithoutReadingIt) {
  const TemporaryFolder folder;
  for (const char* format : {"json", "openmvg-bin", "colmap", "colmap-bin"}) {
    const std::string path = folder.Path(format);
    EXPECT_FALSE(IsScene(path));
    ASSERT_TRUE(WriteScene(TwoViews(), path, format));
    EXPECT_TRUE(IsScene(path)) << format;
  }
  EXPECT_TRUE(IsScene(folder.Write("broken", "{")));
  EXPECT_FALSE(IsScene(folder.Write("K.txt", "900 0 599.5")));
  EXPECT_FALSE(IsScene(folder.Path(".")));
}

TEST(SceneFormats, PlyIsWrittenOnly) {
  const TemporaryFolder folder;
  ASSERT_TRUE(WriteScene(TwoViews(), folder.Path("a.ply")));
  const Result<Scene> scene = ReadScene(folder.Path("a.ply"));
  ASSERT_FALSE(scene.has_value());
  EXPECT_EQ(scene.error().code, ErrorCode::kUnsupported);
}

TEST(SceneFormats, APlaceIsCheckedWithoutAScene) {
  const TemporaryFolder folder;
  for (const char* name : {"a.json", "a.ply", "a.kitti"}) {
    EXPECT_THAT(CheckScenePlace(folder.Path(name)), IsOk()) << name;
  }
  EXPECT_THAT(CheckScenePlace(folder.Path("a.db")),
              IsError(ErrorCode::kNotFound, "no such database"));
  EXPECT_THAT(CheckScenePlace(folder.Path("a"), "colmap-db"),
              IsError(ErrorCode::kNotFound, "no such database"));
  EXPECT_THAT(CheckScenePlace(folder.Path("a"), "1dsfm"),
              IsError(ErrorCode::kUnsupported, "cannot be written"));
  EXPECT_THAT(CheckScenePlace(folder.Path("a.txt")),
              IsError(ErrorCode::kUnsupported, "not a known scene format"));
}

TEST(SceneFormats, AnUnknownFormatIsAnErrorThatListsTheKnown) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("a.mat", "no scene");
  const auto expect_list = [](const Error& error) {
    EXPECT_EQ(error.code, ErrorCode::kUnsupported);
    for (const char* name : {"lowlap", "openmvg-bin", "openmvg-xml", "ply"}) {
      EXPECT_THAT(error.message, HasSubstr(name));
    }
  };
  const Result<Scene> scene = ReadScene(path);
  ASSERT_FALSE(scene.has_value());
  expect_list(scene.error());
  const auto by_extension = WriteScene(TwoViews(), folder.Path("b.mat"));
  ASSERT_FALSE(by_extension.has_value());
  expect_list(by_extension.error());
  const auto by_name = WriteScene(TwoViews(), folder.Path("b.json"), "vrml");
  ASSERT_FALSE(by_name.has_value());
  expect_list(by_name.error());
  EXPECT_FALSE(std::filesystem::exists(folder.Path("b.json")));
  EXPECT_EQ(ReadScene(folder.Path("none.json")).error().code,
            ErrorCode::kNotFound);
}

/// TwoViews with everything that OpenMVG would choke on or lose.
Scene AwkwardScene() {
  Scene scene = TwoViews();
  View view = scene.views.at(0);
  view.filename = "unposed.jpg";
  view.pose_id = 5;
  scene.views[5] = view;
  scene.structure.at(0).observations.push_back({5, kInvalidId, Vec2(1, 2)});
  Landmark lonely;
  lonely.observations = {{0, kInvalidId, Vec2(1, 2)},
                         {5, kInvalidId, Vec2(1, 2)}};
  scene.structure[8] = lonely;
  scene.intrinsics.at(0).fx_px = 498;
  scene.intrinsics.at(0).fy_px = 502;
  scene.features[0].points_px.resize(20);
  return scene;
}

TEST(PrepareForOpenMvg, DropsWhatTheHostRefuses) {
  Scene scene = AwkwardScene();
  scene.intrinsics[3] = scene.intrinsics.at(0);
  scene.poses[9] = scene.poses.at(0);
  const openmvg::PreparedScene prepared = openmvg::PrepareForOpenMvg(scene);
  EXPECT_EQ(prepared.scene.views.size(), 3u);  // posed or not
  EXPECT_EQ(prepared.scene.intrinsics.size(), 1u);
  EXPECT_EQ(prepared.scene.poses.size(), 2u);
  ASSERT_EQ(prepared.scene.structure.size(), 1u);
  EXPECT_TRUE(prepared.scene.structure.at(0) == TwoViews().structure.at(0));
  EXPECT_EQ(prepared.scene.intrinsics.at(0).fx_px,
            prepared.scene.intrinsics.at(0).fy_px);
  EXPECT_DOUBLE_EQ(prepared.scene.intrinsics.at(0).fx_px,
                   std::sqrt(498.0 * 502.0));
  EXPECT_TRUE(prepared.scene.features.empty());
  for (const char* note :
       {"1 intrinsics that no view uses", "1 poses that no view uses",
        "up to 0.399 %", "2 observations", "1 landmarks"}) {
    EXPECT_THAT(prepared.notes, Contains(HasSubstr(note)));
  }
  EXPECT_EQ(prepared.notes.size(), 5u);
}

TEST(PrepareForOpenMvg, LeavesAnOpenMvgSceneAsItIs) {
  const openmvg::PreparedScene prepared =
      openmvg::PrepareForOpenMvg(TwoViews());
  EXPECT_TRUE(prepared.scene == TwoViews());
  EXPECT_THAT(prepared.notes, IsEmpty());
}

TEST(SceneFormats, WritingForOpenMvgPassesTheNotesOn) {
  const TemporaryFolder folder;
  for (const char* format : {"openmvg-json", "openmvg-bin", "openmvg-xml"}) {
    const std::string path = folder.Path(format);
    const auto notes = WriteScene(AwkwardScene(), path, format);
    ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
    EXPECT_EQ(notes->size(), 4u) << format;
    const Result<Scene> scene = ReadScene(path);
    ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
    EXPECT_TRUE(*scene == openmvg::PrepareForOpenMvg(AwkwardScene()).scene);
  }
  // Ours loses nothing and has nothing to note.
  for (const char* name : {"a.json", "a.lowlap"}) {
    const auto notes = WriteScene(AwkwardScene(), folder.Path(name));
    ASSERT_TRUE(notes.has_value()) << notes.error().ToString();
    EXPECT_THAT(*notes, IsEmpty());
    EXPECT_TRUE(*ReadScene(folder.Path(name)) == AwkwardScene());
  }
}

TEST(SceneFormats, AnInvalidSceneIsNotWritten) {
  const TemporaryFolder folder;
  Scene scene = TwoViews();
  scene.poses.at(0).rotation(0, 0) = std::nan("");
  for (const char* name : {"a.json", "a.lowlap", "a.bin", "a.xml"}) {
    const auto notes = WriteScene(scene, folder.Path(name));
    ASSERT_FALSE(notes.has_value()) << name;
    EXPECT_EQ(notes.error().code, ErrorCode::kInvalidScene);
    EXPECT_FALSE(std::filesystem::exists(folder.Path(name)));
  }
}

}  // namespace
}  // namespace lowlap
