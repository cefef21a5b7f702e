#include "third_party_adapters/openmvg/internal/sfm_data_bin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "adapters/openmvg_vectors.h"
#include "lowlap/scene/validation.h"

namespace lowlap::openmvg {
namespace {

using ::testing::HasSubstr;

/// The bytes of kTwoViewsHex with its maps in ascending order.
std::string TwoViewsAscending() {
  const std::string bytes = FromHex(kTwoViewsHex);
  std::string first = bytes.substr(40, 56), second = bytes.substr(96, 53);
  std::swap(first[8], second[8]);  // object ids count in the order of the file
  return bytes.substr(0, 40) + second + first + bytes.substr(149, 125) +
         bytes.substr(414, 140) + bytes.substr(274, 140) +
         bytes.substr(554, 52) + bytes.substr(638, 32) + bytes.substr(606, 32) +
         bytes.substr(670);
}

void AppendBigEndian(const void* value, std::size_t size, std::string& bytes) {
  const std::uint16_t one = 1;
  char little = 0;
  std::memcpy(&little, &one, 1);
  const char* data = static_cast<const char*>(value);
  for (std::size_t n = 0; n < size; ++n) {
    bytes += data[little ? size - 1 - n : n];
  }
}

TEST(SfmDataBin, ReadsWhatOpenMvgWrote) {
  const Scene scene = TwoViews();
  EXPECT_EQ(scene.root_path, "/data/images");
  ASSERT_EQ(scene.views.size(), 2u);
  const View& view = scene.views.at(1);
  EXPECT_EQ(view.local_path, "sub");
  EXPECT_EQ(view.filename, "b.jpg");
  EXPECT_EQ(view.width_px, 640);
  EXPECT_EQ(view.height_px, 480);
  EXPECT_EQ(view.intrinsic_id, 0u);
  EXPECT_EQ(view.pose_id, 1u);
  EXPECT_FALSE(view.center_prior.has_value());
  EXPECT_EQ(scene.views.at(0).filename, "a.jpg");
  ASSERT_EQ(scene.intrinsics.size(), 1u);
  const Intrinsic& intrinsic = scene.intrinsics.at(0);
  EXPECT_EQ(intrinsic.model, CameraModel::kRadialK3);
  EXPECT_EQ(intrinsic.fx_px, 500.0);
  EXPECT_EQ(intrinsic.fy_px, 500.0);
  EXPECT_EQ(intrinsic.principal_point_px, Vec2(320, 240));
  EXPECT_THAT(intrinsic.distortion, ::testing::ElementsAre(-0.1, 0.01, 0.0));
  ASSERT_EQ(scene.poses.size(), 2u);
  Mat3 rotation;
  rotation << 0.8, 0, -0.6, 0, 1, 0, 0.6, 0, 0.8;
  EXPECT_EQ(scene.poses.at(1).rotation, rotation);
  EXPECT_EQ(scene.poses.at(1).center, Vec3(-3, 0, 1));
  ASSERT_EQ(scene.structure.size(), 1u);
  const Landmark& landmark = scene.structure.at(0);
  EXPECT_EQ(landmark.position, Vec3(0.5, -0.25, 5));
  ASSERT_EQ(landmark.observations.size(), 2u);
  EXPECT_EQ(landmark.observations[0].view, 0u);  // sorted by view
  EXPECT_EQ(landmark.observations[0].feature, 7u);
  EXPECT_EQ(landmark.observations[1].pixel_px, Vec2(357.705982, 216.433761));
  EXPECT_TRUE(scene.control_points.empty());
  EXPECT_TRUE(ValidateScene(scene).has_value());
}

TEST(SfmDataBin, ConventionsReprojectTheLandmarkOntoItsObservations) {
  const Scene scene = TwoViews();
  const Landmark& landmark = scene.structure.at(0);
  for (const PointObservation& observation : landmark.observations) {
    const Vec3 in_cam =
        scene.FindPose(observation.view)->CamFromWorld() * landmark.position;
    const Vec2 pixel = scene.FindIntrinsic(observation.view)->Project(in_cam);
    EXPECT_LT((pixel - observation.pixel_px).norm(), 1e-6);
  }
}

TEST(SfmDataBin, ReadsEveryCameraModelAndRepeatedTypes) {
  const Result<Scene> scene = ParseSfmDataBin(FromHex(kAllModelsHex));
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  EXPECT_EQ(scene->root_path, "");
  ASSERT_EQ(scene->views.size(), 3u);
  EXPECT_FALSE(scene->views.at(3).center_prior.has_value());
  EXPECT_EQ(scene->views.at(3).intrinsic_id, 4u);
  ASSERT_TRUE(scene->views.at(2).center_prior.has_value());
  EXPECT_EQ(scene->views.at(2).center_prior->center_in_world, Vec3(1.5, 2, 3));
  EXPECT_EQ(scene->views.at(2).center_prior->weight, Vec3(1, 1, 1));
  EXPECT_EQ(scene->views.at(0).center_prior->center_in_world, Vec3(1, 2, 3));
  ASSERT_EQ(scene->intrinsics.size(), 7u);
  const auto expect = [&](IntrinsicId id, CameraModel model, double focal,
                          const std::vector<double>& distortion) {
    const Intrinsic& intrinsic = scene->intrinsics.at(id);
    EXPECT_EQ(intrinsic.model, model) << id;
    EXPECT_EQ(intrinsic.width_px, 10);
    EXPECT_EQ(intrinsic.height_px, 20);
    EXPECT_EQ(intrinsic.fx_px, focal) << id;
    EXPECT_EQ(intrinsic.distortion, distortion) << id;
  };
  expect(0, CameraModel::kPinhole, 5, {});
  expect(1, CameraModel::kRadialK1, 5, {1e-7});
  expect(2, CameraModel::kRadialK3, 5, {1e-5, 1.0 / 3.0, 1e22});
  expect(3, CameraModel::kBrownT2, 5, {1, 2, 3, 4, 5});
  expect(4, CameraModel::kFisheye, 5, {1, 2, 3, 4});
  expect(5, CameraModel::kSpherical, 0, {});
  expect(6, CameraModel::kPinhole, 6, {});
}

TEST(SfmDataBin, WritesTheBytesThatOpenMvgWritesInAscendingOrder) {
  EXPECT_EQ(SerializeSfmDataBin(TwoViews()), TwoViewsAscending());
}

TEST(SfmDataBin, NamesEachTypeOnceAndKeepsEverything) {
  const Scene scene = *ParseSfmDataBin(FromHex(kAllModelsHex));
  const std::string bytes = SerializeSfmDataBin(scene);
  // The same items in another order take the same room.
  EXPECT_EQ(bytes.size(), FromHex(kAllModelsHex).size());
  const Result<Scene> again = ParseSfmDataBin(bytes);
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE(*again == scene);
}

TEST(SfmDataBin, EveryTruncationIsAnErrorWithItsPlace) {
  for (const char* hex : {kTwoViewsHex, kAllModelsHex}) {
    const std::string bytes = FromHex(hex);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Result<Scene> scene =
          ParseSfmDataBin(std::string_view(bytes).substr(0, size), "cut.bin");
      ASSERT_FALSE(scene.has_value()) << size;
      EXPECT_EQ(scene.error().code, ErrorCode::kParse) << size;
      EXPECT_EQ(scene.error().file, "cut.bin");
      EXPECT_THAT(scene.error().place, HasSubstr("byte ")) << size;
    }
  }
}

TEST(SfmDataBin, EveryDamagedByteIsSurvived) {
  for (const char* hex : {kTwoViewsHex, kAllModelsHex}) {
    const std::string bytes = FromHex(hex);
    int num_errors = 0;
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      for (const int mask : {0x01, 0x40, 0x80, 0xFF}) {
        std::string damaged = bytes;
        damaged[n] = static_cast<char>(damaged[n] ^ mask);
        if (!ParseSfmDataBin(damaged)) ++num_errors;
      }
    }
    EXPECT_GT(num_errors, 0);
  }
}

TEST(SfmDataBin, BytesAfterTheLastItemAreIgnored) {
  const Result<Scene> scene = ParseSfmDataBin(FromHex(kTwoViewsHex) + "rest");
  ASSERT_TRUE(scene.has_value());
  EXPECT_TRUE(*scene == TwoViews());
}

TEST(SfmDataBin, ReadsBigEndian) {
  std::string bytes(1, '\0');
  const auto count = [&](std::uint64_t value) {
    AppendBigEndian(&value, 8, bytes);
  };
  const auto number = [&](double value) { AppendBigEndian(&value, 8, bytes); };
  count(3);
  bytes += "0.3";
  for (int n = 0; n < 3; ++n) count(0);  // root path, views, intrinsics
  count(1);
  const std::uint32_t key = 0x01020304;
  AppendBigEndian(&key, 4, bytes);
  count(3);
  for (int row = 0; row < 3; ++row) {
    count(3);
    for (int column = 0; column < 3; ++column) number(row == column ? 1 : 0);
  }
  count(3);
  for (const double value : {1.5, -2.0, 3e-9}) number(value);
  count(0);
  count(0);
  const Result<Scene> scene = ParseSfmDataBin(bytes);
  ASSERT_TRUE(scene.has_value()) << scene.error().ToString();
  ASSERT_EQ(scene->poses.count(key), 1u);
  EXPECT_EQ(scene->poses.at(key).rotation, Mat3::Identity());
  EXPECT_EQ(scene->poses.at(key).center, Vec3(1.5, -2, 3e-9));
}

TEST(SfmDataBin, ReadsTheOlderVersions) {
  const std::string bytes = FromHex(kTwoViewsHex);
  // 0.2: no type before a view. 0.1: no control points either.
  std::string old =
      bytes.substr(0, 44) + bytes.substr(48, 52) + bytes.substr(104);
  old[11] = '2';
  const Result<Scene> version_2 = ParseSfmDataBin(old);
  ASSERT_TRUE(version_2.has_value()) << version_2.error().ToString();
  EXPECT_TRUE(*version_2 == TwoViews());
  old[11] = '1';
  old.resize(old.size() - 8);
  const Result<Scene> version_1 = ParseSfmDataBin(old);
  ASSERT_TRUE(version_1.has_value()) << version_1.error().ToString();
  EXPECT_TRUE(*version_1 == TwoViews());
}

/// kTwoViewsHex with bytes replaced from `offset` on.
Result<Scene> ParsePatched(std::size_t offset, const std::string& patch) {
  std::string bytes = FromHex(kTwoViewsHex);
  bytes.replace(offset, patch.size(), patch);
  return ParseSfmDataBin(bytes);
}

TEST(SfmDataBin, MalformedContentIsNamed) {
  const auto expect = [](const Result<Scene>& scene, ErrorCode code,
                         const std::string& message, const std::string& place) {
    ASSERT_FALSE(scene.has_value()) << message;
    EXPECT_EQ(scene.error().code, code) << scene.error().ToString();
    EXPECT_THAT(scene.error().message, HasSubstr(message));
    EXPECT_EQ(scene.error().place, place);
  };
  using namespace std::string_literals;
  const std::string nan = "\0\0\0\0\0\0\xF8\x7F"s;
  expect(ParsePatched(0, "\x07"), ErrorCode::kParse, "first byte", "byte 0");
  expect(ParsePatched(11, "9"), ErrorCode::kUnsupported, "version \"0.9\"",
         "byte 1");
  expect(ParsePatched(32, std::string(8, '\x7F')), ErrorCode::kParse,
         "does not fit", "byte 32");
  expect(ParsePatched(44, "\0\0\0\0"s), ErrorCode::kParse, "null pointer",
         "byte 44");
  expect(ParsePatched(44, "\5\0\0\0"s), ErrorCode::kParse, "before it is named",
         "byte 44");
  expect(ParsePatched(48, "\1\0\0\0"s), ErrorCode::kParse, "no content",
         "byte 48");
  expect(ParsePatched(84, "\2\0\0\0"s), ErrorCode::kInvalidScene,
         "differs from the key", "byte 84");
  expect(ParsePatched(96, "\1\0\0\0"s), ErrorCode::kInvalidScene, "",
         "byte 137");
  expect(ParsePatched(173, "q"), ErrorCode::kUnsupported, "camera model",
         "byte 161");
  expect(ParsePatched(202, nan), ErrorCode::kParse, "not finite", "byte 202");
  expect(ParsePatched(234, "\2"), ErrorCode::kParse, "vector of 3", "byte 234");
  expect(ParsePatched(278, "\2"), ErrorCode::kParse, "3 rows", "byte 278");
  expect(ParsePatched(414, "\1"), ErrorCode::kInvalidScene, "id 1 is repeated",
         "byte 414");
  expect(ParsePatched(654, nan), ErrorCode::kParse, "not finite", "byte 654");
  expect(ParsePatched(598, std::string(8, '\xFF')), ErrorCode::kParse,
         "does not fit", "byte 598");
}

TEST(SfmDataBin, AMissingFileIsNotFound) {
  const Result<Scene> scene = ReadSfmDataBin("no/such/sfm_data.bin");
  ASSERT_FALSE(scene.has_value());
  EXPECT_EQ(scene.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace lowlap::openmvg
