#include "lowlap/io/scene_format.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "lowlap/core/internal/atomic_file.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

std::string FormatName(const std::string& path) {
  static const SceneFormats formats = OwnSceneFormats();
  const auto format = FindSceneFormat(formats, path);
  return format ? (*format)->name : "";
}

TEST(SceneFormat, RecognisesByExtension) {
  EXPECT_EQ(FormatName("a/sfm_data.json"), "json");
  EXPECT_EQ(FormatName("SCENE.JSON"), "json");
  EXPECT_EQ(FormatName("scene.lowlap"), "lowlap");
  EXPECT_EQ(FormatName("scene.ply"), "ply");
  EXPECT_EQ(FormatName("scene.xyz"), "");
  EXPECT_EQ(FormatName("json"), "");
  EXPECT_EQ(FormatName(""), "");
}

TEST(SceneFormat, AFolderIsNoFile) {
  const std::string folder = ::testing::TempDir() + "/lowlap_folder.json";
  std::filesystem::create_directory(folder);
  EXPECT_EQ(FormatName(folder), "");
  std::filesystem::remove(folder);
}

TEST(SceneFormat, UnknownFormatsListTheKnownOnes) {
  const SceneFormats formats = OwnSceneFormats();
  EXPECT_THAT(FindSceneFormat(formats, "scene.xyz"),
              IsError(ErrorCode::kUnsupported, "*.lowlap"));
  EXPECT_THAT(FindNamedSceneFormat(formats, "colmap"),
              IsError(ErrorCode::kUnsupported, "*.lowlap"));
  EXPECT_EQ((*FindNamedSceneFormat(formats, "json"))->extension, ".json");
}

TEST(SceneFormat, WritesAndReads) {
  const Scene scene = testing::FullScene();
  for (const SceneFormat& format : OwnSceneFormats()) {
    const std::string path =
        ::testing::TempDir() + "/lowlap_format_test" + format.extension;
    ASSERT_TRUE(format.Recognizes(path));
    FileSet files;
    ASSERT_THAT(format.write(scene, path, &files), IsOk());
    EXPECT_FALSE(std::filesystem::exists(path));
    ASSERT_THAT(files.Commit(), IsOk());
    SceneNotes notes;
    if (format.read) {
      EXPECT_EQ(*format.read(path, &notes), scene);
    }
    EXPECT_TRUE(notes.empty());
    std::filesystem::remove(path);
  }
}

TEST(SceneFormat, WhatCannotBeWrittenIsNamed) {
  Scene scene = testing::FullScene();
  scene.root_path = "\xFF";
  FileSet files;
  for (const char* name : {"json", "lowlap"}) {
    const SceneFormats formats = OwnSceneFormats();
    EXPECT_THAT(
        (*FindNamedSceneFormat(formats, name))->write(scene, "out", &files),
        IsError(ErrorCode::kInvalidScene, "out: $.root_path"));
  }
}

}  // namespace
}  // namespace lowlap
