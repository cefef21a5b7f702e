#include "lowlap/pipeline/image_collection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "exif_writing.h"

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
  AddImage("c.png", 30, 40);
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
  IntrinsicSource both = Focal(9);
  both.calibration = Mat3::Identity();
  const auto refused = SceneFromImages(folder_.string(), both, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
}

TEST_F(ImageCollection, WithoutIntrinsicsTheFocalLengthsComeFromExif) {
  AddImage("a.jpg", 60, 40);
  AddImage("b.jpg", 60, 40);
  AddImage("c.jpg", 60, 40);
  testing::AddExif({{EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, 36}},
                   (folder_ / "a.jpg").string());
  testing::AddExif({{EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, 36}},
                   (folder_ / "b.jpg").string());
  const auto none =
      SceneFromImages(folder_.string(), IntrinsicSource(), {"a.jpg"});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::kInsufficientData);
  EXPECT_THAT(none.error().file, ::testing::HasSubstr("c.jpg"));
  testing::AddExif({{EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, 18}},
                   (folder_ / "c.jpg").string());
  const auto scene = SceneFromImages(folder_.string(), IntrinsicSource(), {});
  ASSERT_TRUE(scene) << scene.error().ToString();
  EXPECT_EQ(scene->intrinsics.size(), 2u);
  EXPECT_EQ(scene->views.at(0).intrinsic_id, scene->views.at(1).intrinsic_id);
  EXPECT_NEAR(scene->FindIntrinsic(0)->fx_px, 60, 1e-9);
  EXPECT_NEAR(scene->FindIntrinsic(2)->fy_px, 30, 1e-9);
  EXPECT_EQ(scene->FindIntrinsic(0)->principal_point_px, Vec2(29.5, 19.5));
}

TEST_F(ImageCollection, IntrinsicsOfAnotherSceneGoByFileName) {
  AddImage("a.png", 40, 30);
  AddImage("b.png", 40, 30);
  Intrinsic wide;
  wide.model = CameraModel::kRadialK1;
  wide.width_px = 40;
  wide.height_px = 30;
  wide.fx_px = wide.fy_px = 25;
  wide.distortion = {-0.2};
  Intrinsic tele = wide;
  tele.fx_px = tele.fy_px = 80;
  IntrinsicSource source;
  source.scene.emplace();
  source.scene->intrinsics = {{3, tele}, {8, wide}};
  View view;
  view.intrinsic_id = 8;
  view.filename = "b.png";
  source.scene->views[5] = view;
  const auto unlisted = SceneFromImages(folder_.string(), source, {});
  ASSERT_FALSE(unlisted);
  EXPECT_THAT(unlisted.error().file, ::testing::HasSubstr("a.png"));
  view.intrinsic_id = 3;
  view.filename = "sub/a.png";
  source.scene->views[6] = view;
  const auto scene = SceneFromImages(folder_.string(), source, {});
  ASSERT_TRUE(scene) << scene.error().ToString();
  EXPECT_TRUE(*scene->FindIntrinsic(0) == tele);
  EXPECT_TRUE(*scene->FindIntrinsic(1) == wide);
  EXPECT_EQ(scene->views.at(1).intrinsic_id, 8u);

  // One intrinsic is that of every image; its size must fit.
  source.scene->views.clear();
  source.scene->intrinsics.erase(3);
  const auto one = SceneFromImages(folder_.string(), source, {});
  ASSERT_TRUE(one);
  EXPECT_TRUE(*one->FindIntrinsic(0) == wide);
  source.scene->intrinsics.at(8).width_px = 60;
  const auto misfit = SceneFromImages(folder_.string(), source, {});
  ASSERT_FALSE(misfit);
  EXPECT_THAT(misfit.error().message, ::testing::HasSubstr("60 x 30"));
}

TEST_F(ImageCollection, FoldersTellViewsOfOneNameApart) {
  fs::create_directories(folder_ / "cam1");
  AddImage("cam1/a.png", 40, 30);
  AddImage("cam1/b.png", 40, 30);
  IntrinsicSource source;
  source.scene.emplace();
  for (const std::uint32_t camera : {1, 2}) {
    Intrinsic& intrinsic = source.scene->intrinsics[camera];
    intrinsic.width_px = 40;
    intrinsic.height_px = 30;
    intrinsic.fx_px = intrinsic.fy_px = 25.0 * camera;
    intrinsic.principal_point_px = Vec2(19.5, 14.5);
    for (const char* name : {"a.png", "b.png"}) {
      View view;
      view.intrinsic_id = camera;
      view.filename = "cam" + std::to_string(camera) + "/" + name;
      const auto id = static_cast<std::uint32_t>(source.scene->views.size());
      source.scene->views[id] = view;
    }
  }
  const std::string folder = (folder_ / "cam1").string();
  const auto scene = SceneFromImages(folder, source, {});
  ASSERT_TRUE(scene) << scene.error().ToString();
  EXPECT_EQ(scene->FindIntrinsic(0)->fx_px, 25);
  EXPECT_EQ(scene->FindIntrinsic(1)->fx_px, 25);

  fs::rename(folder_ / "cam1", folder_ / "copy");
  const auto copy = SceneFromImages((folder_ / "copy").string(), source, {});
  ASSERT_FALSE(copy);
  EXPECT_THAT(copy.error().message,
              ::testing::HasSubstr("'cam1/a.png' and 'cam2/a.png'"));
}

TEST_F(ImageCollection, SaysThatSubfoldersAreNotTakenAndSkipsHiddenFiles) {
  fs::create_directories(folder_ / "sub");
  AddImage("sub/a.png", 8, 8);
  const auto none = SceneFromImages(folder_.string(), Focal(9), {});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, ::testing::HasSubstr("subfolders"));
  AddImage("a.png", 8, 8);
  AddImage("b.png", 8, 8);
  std::ofstream(folder_ / "._a.png") << "of another system";
  std::vector<std::string> notes;
  const auto scene = SceneFromImages(folder_.string(), Focal(9), {}, &notes);
  ASSERT_TRUE(scene) << scene.error().ToString();
  EXPECT_EQ(scene->views.size(), 2u);
  EXPECT_THAT(
      notes, ::testing::ElementsAre("photographs in subfolders are not taken"));
}

TEST_F(ImageCollection, ACalibrationOfAnotherSizeIsRefusedAndNamed) {
  AddImage("a.png", 400, 300);
  AddImage("b.png", 400, 300);
  for (const double factor : {0.25, 0.5, 2.0, 4.0}) {
    IntrinsicSource source;
    source.calibration = Mat3(Vec3(500, 500, 1).asDiagonal());
    (*source.calibration)(0, 2) = 204;
    (*source.calibration)(1, 2) = 148;
    source.calibration->topRows<2>() *= factor;
    const auto refused = SceneFromImages(folder_.string(), source, {});
    ASSERT_FALSE(refused) << factor;
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(refused.error().file, ::testing::HasSubstr("a.png"));
    EXPECT_THAT(refused.error().message, ::testing::HasSubstr("400 x 300"));
  }
  IntrinsicSource source;
  source.calibration = Mat3(Vec3(500, 500, 1).asDiagonal());
  (*source.calibration)(0, 2) = 5000;
  EXPECT_FALSE(SceneFromImages(folder_.string(), source, {}));
  // A crop is possible, but worth a word.
  (*source.calibration)(0, 2) = 280;
  (*source.calibration)(1, 2) = 150;
  std::vector<std::string> notes;
  EXPECT_TRUE(SceneFromImages(folder_.string(), source, {}, &notes));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], ::testing::HasSubstr("(280.0, 150.0) lies 20 %"));
}

TEST_F(ImageCollection, PhotographsOfAnotherSizeGetTheirCalibrationScaled) {
  AddImage("a.png", 400, 300);
  AddImage("b.png", 400, 300);
  AddImage("c.png", 200, 150);
  IntrinsicSource matrix;
  matrix.calibration = Mat3::Identity();
  (*matrix.calibration) << 500, 0, 204, 0, 510, 148, 0, 0, 1;
  for (const IntrinsicSource& source : {matrix, Focal(500)}) {
    std::vector<std::string> notes;
    const auto scene = SceneFromImages(folder_.string(), source, {}, &notes);
    ASSERT_TRUE(scene) << scene.error().ToString();
    const Intrinsic* large = scene->FindIntrinsic(0);
    const Intrinsic* half = scene->FindIntrinsic(2);
    EXPECT_EQ(large->fx_px, 500);
    EXPECT_EQ(half->fx_px, 250);
    EXPECT_EQ(half->fy_px, 0.5 * large->fy_px);
    EXPECT_EQ(half->principal_point_px,
              0.5 * large->principal_point_px - Vec2(0.25, 0.25));
    EXPECT_EQ(notes, std::vector<std::string>{
                         "c.png: the calibration was scaled by 0.5"});
  }
  AddImage("c.png", 200, 190);
  const auto cropped = SceneFromImages(folder_.string(), matrix, {});
  ASSERT_FALSE(cropped);
  EXPECT_THAT(cropped.error().file, ::testing::HasSubstr("c.png"));
}

TEST_F(ImageCollection, TurnedPhotographsGoByTheirExifOrientation) {
  AddImage("a.jpg", 400, 300);
  AddImage("b.jpg", 400, 300);
  AddImage("c.jpg", 300, 400);
  IntrinsicSource source;
  source.calibration = Mat3::Identity();
  (*source.calibration) << 500, 0, 204, 0, 510, 148, 0, 0, 1;
  const auto unknown = SceneFromImages(folder_.string(), source, {});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().file, ::testing::HasSubstr("c.jpg"));
  EXPECT_THAT(unknown.error().message, ::testing::HasSubstr("turned"));
  for (const int orientation : {6, 8}) {
    AddImage("c.jpg", 300, 400);
    testing::AddExif({{EXIF_TAG_ORIENTATION, orientation}},
                     (folder_ / "c.jpg").string());
    std::vector<std::string> notes;
    const auto scene = SceneFromImages(folder_.string(), source, {}, &notes);
    ASSERT_TRUE(scene) << scene.error().ToString();
    // The upright picture's pixel (x, y) is stored at (y, 399 - x) if reading
    // it takes a turn clockwise, otherwise at (299 - y, x).
    const Intrinsic* turned = scene->FindIntrinsic(2);
    EXPECT_EQ(turned->fx_px, 510);
    EXPECT_EQ(turned->fy_px, 500);
    EXPECT_EQ(turned->principal_point_px,
              orientation == 6 ? Vec2(148, 195) : Vec2(151, 204));
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_THAT(notes[0], ::testing::HasSubstr("c.jpg"));
  }
}

// The principal point is 9 % off the middle of the copies.
TEST_F(ImageCollection, LittleShrunkCopiesAreKnownByTheSizeAsTaken) {
  const auto add_taken_at = [&](int width, int height) {
    for (const char* name : {"a.jpg", "b.jpg"}) {
      AddImage(name, 400, 300);
      testing::AddExif({{EXIF_TAG_PIXEL_X_DIMENSION, width},
                        {EXIF_TAG_PIXEL_Y_DIMENSION, height}},
                       (folder_ / name).string());
    }
  };
  add_taken_at(472, 354);
  IntrinsicSource source;
  source.calibration = Mat3::Identity();
  (*source.calibration) << 590, 0, 235.5, 0, 590, 176.5, 0, 0, 1;
  const auto shrunk = SceneFromImages(folder_.string(), source, {});
  ASSERT_TRUE(shrunk) << shrunk.error().ToString();
  EXPECT_NEAR(shrunk->FindIntrinsic(0)->fx_px, 500, 1e-9);
  // A lens that is off its centre stays so, if no size explains it.
  add_taken_at(800, 600);
  const auto shifted = SceneFromImages(folder_.string(), source, {});
  ASSERT_TRUE(shifted) << shifted.error().ToString();
  EXPECT_EQ(shifted->FindIntrinsic(0)->fx_px, 590);
}

TEST_F(ImageCollection, ShrunkCopiesAreKnownByTheSizeAsTaken) {
  const std::map<ExifTag, double> taken = {{EXIF_TAG_PIXEL_X_DIMENSION, 400},
                                           {EXIF_TAG_PIXEL_Y_DIMENSION, 300}};
  for (const char* name : {"a.jpg", "b.jpg"}) {
    AddImage(name, 200, 150);
    testing::AddExif(taken, (folder_ / name).string());
  }
  IntrinsicSource source;
  source.calibration = Mat3::Identity();
  (*source.calibration) << 500, 0, 204, 0, 510, 148, 0, 0, 1;
  std::vector<std::string> notes;
  const auto scene = SceneFromImages(folder_.string(), source, {}, &notes);
  ASSERT_TRUE(scene) << scene.error().ToString();
  EXPECT_EQ(scene->FindIntrinsic(0)->fx_px, 250);
  EXPECT_EQ(notes.size(), 2u);
}

TEST_F(ImageCollection, FilesThatCannotBeReadAreNamedAtTheDoor) {
  for (const char* name : {"a.png", "b.png"}) AddImage(name, 8, 8);
  fs::create_symlink("loop.png", folder_ / "loop.png");
  const auto loop = SceneFromImages(folder_.string(), Focal(9), {});
  ASSERT_FALSE(loop);
  EXPECT_EQ(loop.error().code, ErrorCode::kIo);
  EXPECT_THAT(loop.error().file, ::testing::HasSubstr("loop.png"));
  fs::remove(folder_ / "loop.png");
  std::ofstream(folder_ / "caf\xe9.png") << "Latin-1";
  const auto named = SceneFromImages(folder_.string(), Focal(9), {});
  ASSERT_FALSE(named);
  EXPECT_EQ(named.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(named.error().file, ::testing::HasSubstr("caf\\xE9.png"));
}

TEST_F(ImageCollection, ViewsAreFoundByNameStemOrId) {
  for (const char* name : {"a.png", "b.png", "c.png"}) AddImage(name, 8, 8);
  const auto scene = SceneFromImages(folder_.string(), Focal(9), {});
  const auto views = FindViews(*scene, {"c", "a.png", "1"});
  ASSERT_TRUE(views);
  EXPECT_EQ(*views, (std::vector<ViewId>{0, 1, 2}));
  EXPECT_FALSE(FindViews(*scene, {"d"}));
}

TEST_F(ImageCollection, AFocalLengthInMillimetresIsToldFromPixels) {
  AddImage("a.png", 120, 80);
  AddImage("b.png", 120, 80);
  for (const auto& [focal_px, is_told] : std::map<double, bool>{
           {20, true}, {24, false}, {3600, false}, {3700, true}}) {
    std::vector<std::string> notes;
    ASSERT_TRUE(SceneFromImages(folder_.string(), Focal(focal_px), {}, &notes));
    const bool is_there =
        std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
          return note.find("millimetres") != std::string::npos;
        });
    EXPECT_EQ(is_there, is_told) << focal_px;
  }
}

}  // namespace
}  // namespace lowlap
