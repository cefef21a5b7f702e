#include "lowlap/io/scene_format.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

std::string FormatName(const std::string& path) {
  static const SceneFormats formats = OwnSceneFormats();
  const auto format = FindSceneFormat(formats, path);
  return format ? (*format)->Name() : "";
}

TEST(SceneFormat, RecognisesByExtension) {
  EXPECT_EQ(FormatName("a/sfm_data.json"), "json");
  EXPECT_EQ(FormatName("SCENE.JSON"), "json");
  EXPECT_EQ(FormatName("scene.lowlap"), "lowlap");
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
  EXPECT_THAT(FindSceneFormat(OwnSceneFormats(), "scene.xyz"),
              IsError(ErrorCode::kUnsupported, "*.lowlap"));
}

TEST(SceneFormat, WritesAndReads) {
  const Scene scene = testing::FullScene();
  for (const auto& format : OwnSceneFormats()) {
    const std::string path =
        ::testing::TempDir() + "/lowlap_format_test." + format->Name();
    ASSERT_TRUE(format->Recognizes(path));
    ASSERT_TRUE(format->CanWrite());
    ASSERT_THAT(format->Write(scene, path), IsOk());
    EXPECT_EQ(*format->Read(path), scene);
    std::filesystem::remove(path);
  }
}

class ReadOnlyFormat : public SceneFormat {
 public:
  std::string Name() const override { return "read-only"; }
  std::string Description() const override { return "for this test"; }
  bool Recognizes(const std::string&) const override { return true; }
  Result<Scene> Read(const std::string&) const override { return Scene(); }
  bool CanWrite() const override { return false; }
};

TEST(SceneFormat, WritingIsRefusedWhereItIsNotOffered) {
  EXPECT_THAT(ReadOnlyFormat().Write(Scene(), "out"),
              IsError(ErrorCode::kUnsupported, "read-only"));
}

}  // namespace
}  // namespace lowlap
