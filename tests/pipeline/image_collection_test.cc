#include "lowlap/pipeline/image_collection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

namespace lowlap {
namespace {

namespace fs = std::filesystem;

class ImageCollection : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("lowlap_images_" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sub.png");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void AddImage(const std::string& name, int width, int height) {
    cv::imwrite((folder_ / name).string(),
                cv::Mat(height, width, CV_8UC1, cv::Scalar(90)));
  }

  static IntrinsicSource Focal(double focal_px) {
    IntrinsicSource source;
    source.focal_px = focal_px;
    return source;
  }

  fs::path folder_;
};

TEST_F(ImageCollection, ViewsFollowTheFileNamesAndShareIntrinsicsBySize) {
  AddImage("b.png", 40, 30);
  AddImage("a.JPG", 40, 30);
  AddImage("c.png", 20, 30);
  std::ofstream(folder_ / "notes.txt") << "no image";
  const auto scene = SceneFromImages(folder_.string(), Focal(50), {});
  ASSERT_TRUE(scene) << scene.error().ToString();
  ASSERT_EQ(scene->views.size(), 3u);
  EXPECT_EQ(scene->views.at(0).filename, "a.JPG");
  EXPECT_EQ(scene->views.at(1).filename, "b.png");
  EXPECT_EQ(scene->intrinsics.size(), 2u);
  EXPECT_EQ(scene->views.at(0).intrinsic_id, scene->views.at(1).intrinsic_id);
  EXPECT_NE(scene->views.at(0).intrinsic_id, scene->views.at(2).intrinsic_id);
  const Intrinsic* intrinsic = scene->FindIntrinsic(0);
  EXPECT_EQ(intrinsic->principal_point_px, Vec2(19.5, 14.5));
}

TEST_F(ImageCollection, ACalibrationMatrixKeepsBothFocalLengths) {
  AddImage("a.png", 40, 30);
  AddImage("b.png", 40, 30);
  IntrinsicSource source;
  source.calibration = Mat3::Identity();
  (*source.calibration) << 50, 0, 21, 0, 51, 14, 0, 0, 1;
  const auto scene = SceneFromImages(folder_.string(), source, {});
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->FindIntrinsic(1)->fx_px, 50);
  EXPECT_EQ(scene->FindIntrinsic(1)->fy_px, 51);
  EXPECT_EQ(scene->FindIntrinsic(1)->principal_point_px, Vec2(21, 14));
}

TEST_F(ImageCollection, ExcludedImagesAreLeftOutAndUnknownOnesRefused) {
  for (const char* name : {"a.png", "b.png", "c.png"}) AddImage(name, 8, 8);
  const auto scene = SceneFromImages(folder_.string(), Focal(9), {"b"});
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->views.at(1).filename, "c.png");
  const auto refused = SceneFromImages(folder_.string(), Focal(9), {"z.png"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
}

TEST_F(ImageCollection, BadInputIsNamed) {
  const auto missing = SceneFromImages("no/such/folder", Focal(9), {});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  AddImage("a.png", 8, 8);
  const auto too_few = SceneFromImages(folder_.string(), Focal(9), {});
  ASSERT_FALSE(too_few);
  EXPECT_EQ(too_few.error().code, ErrorCode::kInsufficientData);
  std::ofstream(folder_ / "b.png") << "not a picture";
  const auto broken = SceneFromImages(folder_.string(), Focal(9), {});
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().file, ::testing::HasSubstr("b.png"));
  const auto neither = SceneFromImages(folder_.string(), IntrinsicSource(), {});
  ASSERT_FALSE(neither);
  EXPECT_EQ(neither.error().code, ErrorCode::kInvalidArgument);
}

TEST_F(ImageCollection, ViewsAreFoundByNameStemOrId) {
  for (const char* name : {"a.png", "b.png", "c.png"}) AddImage(name, 8, 8);
  const auto scene = SceneFromImages(folder_.string(), Focal(9), {});
  const auto views = FindViews(*scene, {"c", "a.png", "1"});
  ASSERT_TRUE(views);
  EXPECT_EQ(*views, (std::vector<ViewId>{0, 1, 2}));
  EXPECT_FALSE(FindViews(*scene, {"d"}));
}

}  // namespace
}  // namespace lowlap
