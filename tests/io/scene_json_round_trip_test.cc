#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>
#include <regex>
#include <string>

#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/io/internal/json/scene_json.h"
#include "lowlap/io/internal/scene_binary.h"
#include "lowlap/io/scene_format.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::FullScene;
using testing::IsError;
using testing::IsOk;
using testing::RandomScene;

TEST(SceneFiles, FullSceneSurvivesBothForms) {
  const Scene scene = FullScene();
  const Result<std::string> text = FormatSceneJson(scene);
  const Result<std::string> bytes = FormatSceneBinary(scene);
  ASSERT_THAT(text, IsOk());
  ASSERT_THAT(bytes, IsOk());
  const Result<Scene> from_text = ParseSceneJson(*text);
  const Result<Scene> from_bytes = ParseSceneBinary(*bytes);
  ASSERT_THAT(from_text, IsOk());
  ASSERT_THAT(from_bytes, IsOk());
  EXPECT_EQ(*from_text, scene);
  EXPECT_EQ(*from_bytes, scene);
  // And so every byte, through the other form as well.
  EXPECT_EQ(*FormatSceneBinary(*from_text), *bytes);
  EXPECT_EQ(*FormatSceneJson(*from_bytes), *text);
}

// Written by the last programs of their versions from FullScene.
std::string OldFile(const std::string& name) {
  return std::string(LOWLAP_IO_TEST_DATA) + "/" + name;
}

void ExpectOldFiles(const std::string& version, const Scene& expected) {
  const Result<Scene> from_text = ReadSceneJson(OldFile(version + ".json"));
  const Result<Scene> from_bytes =
      ReadSceneBinary(OldFile(version + ".lowlap"));
  ASSERT_THAT(from_text, IsOk());
  ASSERT_THAT(from_bytes, IsOk());
  EXPECT_EQ(*from_text, expected);
  EXPECT_EQ(*from_bytes, expected);
}

Scene SceneOfVersion7() {
  Scene scene = FullScene();
  scene.unrelated_pairs.clear();
  return scene;
}

TEST(SceneFiles, FilesOfVersion7DoNotSayWhatWasComparedInVain) {
  ExpectOldFiles("version_7", SceneOfVersion7());
}

Scene SceneOfVersion6() {
  Scene scene = SceneOfVersion7();
  for (auto& [view, features] : scene.features) {
    features.repeated_points.clear();
    features.repeated_segments.clear();
  }
  return scene;
}

TEST(SceneFiles, FilesOfVersion6DoNotSayWhatRepeats) {
  ExpectOldFiles("version_6", SceneOfVersion6());
}

Scene SceneOfVersion5() {
  Scene scene = SceneOfVersion6();
  for (auto& [views, pose] : scene.relative_poses) pose.weakness.reset();
  return scene;
}

TEST(SceneFiles, FilesOfVersion5HaveNoWeaknesses) {
  ExpectOldFiles("version_5", SceneOfVersion5());
}

Scene SceneOfVersion4() {
  Scene scene = SceneOfVersion5();
  for (auto& [id, pose] : scene.poses) pose.center_covariance.reset();
  return scene;
}

TEST(SceneFiles, FilesOfVersion4HaveNoCovariancesOfCentres) {
  ExpectOldFiles("version_4", SceneOfVersion4());
}

TEST(SceneFiles, FilesOfVersion3HaveTheThreeKindsOfTheirTime) {
  Scene expected = SceneOfVersion4();
  expected.given_intrinsics.clear();
  ExpectOldFiles("version_3", expected);
}

// Version 2 had neither second modes nor shares of information, and no section
// of them.
TEST(SceneFiles, FilesOfVersion2HaveNoDetailsOfTheRatios) {
  Scene expected = SceneOfVersion4();
  expected.given_intrinsics.clear();
  for (ScaleRatio& ratio : expected.scale_ratios) {
    ratio.second_mode.reset();
    for (KindSupport& kind : ratio.kinds) kind.information_share = 0;
  }
  std::string text = *ReadWholeFile(OldFile("version_3.json"));
  const auto replace_all = [&](const std::string& from, const std::string& to) {
    text = std::regex_replace(text, std::regex(from), to);
  };
  replace_all("\"version\": 3", "\"version\": 2");
  replace_all(", \"information_share\": [0-9.]*", "");
  replace_all("\"second_mode\": \\{[^}]*\\}, ", "");
  const Result<Scene> from_text = ParseSceneJson(text);
  ASSERT_THAT(from_text, IsOk());
  EXPECT_EQ(*from_text, expected);

  std::string bytes = *ReadWholeFile(OldFile("version_3.lowlap"));
  bytes.resize(bytes.rfind("RATD"));
  bytes[8] = 2;
  bytes[12] = 13;
  const Result<Scene> from_bytes = ParseSceneBinary(bytes);
  ASSERT_THAT(from_bytes, IsOk());
  EXPECT_EQ(*from_bytes, expected);
}

TEST(SceneFiles, EmptySceneSurvivesBothForms) {
  const Result<Scene> from_text = ParseSceneJson(*FormatSceneJson(Scene()));
  const Result<Scene> from_bytes =
      ParseSceneBinary(*FormatSceneBinary(Scene()));
  ASSERT_THAT(from_text, IsOk());
  ASSERT_THAT(from_bytes, IsOk());
  EXPECT_EQ(*from_text, Scene());
  EXPECT_EQ(*from_bytes, Scene());
}

TEST(SceneFiles, RandomScenesSurviveBothForms) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto size = static_cast<std::uint32_t>(seed);
    const Scene scene = RandomScene(seed, 2 + size, 20 * size, 5 * size);
    const Result<std::string> text = FormatSceneJson(scene);
    const Result<std::string> bytes = FormatSceneBinary(scene);
    ASSERT_THAT(text, IsOk());
    ASSERT_THAT(bytes, IsOk());
    EXPECT_EQ(*ParseSceneJson(*text), scene);
    EXPECT_EQ(*ParseSceneBinary(*bytes), scene);
  }
}

// Any finite pattern of bits, compared as bits.
TEST(SceneFiles, RealsSurviveTheTextToTheLastBit) {
  Random random(11);
  Scene scene;
  scene.views[0].filename = "a.jpg";
  auto& points = scene.features[0].points_px;
  const auto add = [&](double x) { points.emplace_back(x, -x); };
  for (const double x :
       {0.0, 1.0, 0.1, 1.0 / 3, 1e22, 1e23, 123456789012345680.0, 5e-324,
        std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
        9007199254740993.0, 18446744073709551616.0, 1e21, 1e-7}) {
    add(x);
  }
  while (points.size() < 5000) {
    const std::uint64_t bits = random.NextBits();
    double x;
    std::memcpy(&x, &bits, sizeof x);
    if (std::isfinite(x)) add(x);
  }
  const Result<Scene> read = ParseSceneJson(*FormatSceneJson(scene));
  ASSERT_THAT(read, IsOk());
  const auto& restored = read->features.at(0).points_px;
  ASSERT_EQ(restored.size(), points.size());
  EXPECT_EQ(
      std::memcmp(restored.data(), points.data(), points.size() * sizeof(Vec2)),
      0);
}

// The text form, or the binary one.
Status Write(const char* extension, const Scene& scene,
             const std::string& path) {
  const SceneFormats formats = OwnSceneFormats();
  FileSet files;
  const auto notes = (*FindSceneFormat(formats, std::string("a") + extension))
                         ->write(scene, path, &files);
  return notes ? files.Commit() : tl::unexpected<Error>(notes.error());
}

TEST(SceneFiles, InvalidScenesAreNotWritten) {
  Scene scene = FullScene();
  scene.poses[100].rotation.setZero();
  const std::string folder = ::testing::TempDir();
  for (const char* extension : {".json", ".lowlap"}) {
    const std::string path = folder + "/lowlap_io_invalid_scene";
    EXPECT_THAT(Write(extension, scene, path),
                IsError(ErrorCode::kInvalidScene,
                        path + ": $.extrinsics[key=100].rotation"));
    EXPECT_FALSE(std::filesystem::exists(path));
  }
}

TEST(SceneFiles, FilesSurviveAndErrorsNameTheFile) {
  const Scene scene = RandomScene(1, 4, 30, 10);
  const std::string folder = ::testing::TempDir();
  const std::string json = folder + "/lowlap_io_test.json";
  const std::string binary = folder + "/lowlap_io_test.lowlap";
  ASSERT_THAT(Write(".json", scene, json), IsOk());
  ASSERT_THAT(Write(".lowlap", scene, binary), IsOk());
  EXPECT_EQ(*ReadSceneJson(json), scene);
  EXPECT_EQ(*ReadSceneBinary(binary), scene);
  // Each form read as the other.
  EXPECT_THAT(ReadSceneJson(binary), IsError(ErrorCode::kParse, binary));
  EXPECT_THAT(ReadSceneBinary(json),
              IsError(ErrorCode::kParse, "not a .lowlap file"));
  std::filesystem::remove(json);
  std::filesystem::remove(binary);
  EXPECT_THAT(ReadSceneJson(json), IsError(ErrorCode::kNotFound, json));
  EXPECT_THAT(ReadSceneBinary(binary), IsError(ErrorCode::kNotFound, binary));
  EXPECT_THAT(ReadSceneJson(folder), IsError(ErrorCode::kIo, folder));
  EXPECT_THAT(Write(".json", scene, folder + "/no/such/folder/a.json"),
              IsError(ErrorCode::kIo, "no/such/folder"));
}

}  // namespace
}  // namespace lowlap
