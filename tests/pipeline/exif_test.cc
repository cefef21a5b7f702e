#include "lowlap/pipeline/internal/measure/exif.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "exif_writing.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;
using testing::AddExif;
using testing::IsError;

class ExifTest : public ::testing::Test {
 protected:
  ~ExifTest() override { fs::remove(path_); }

  /// What the tags tell of a photograph of 300 x 200 pixels.
  std::optional<double> FocalPx(const std::map<ExifTag, double>& tags) {
    cv::imwrite(path_, cv::Mat(200, 300, CV_8UC1, cv::Scalar(90)));
    if (!tags.empty()) AddExif(tags, path_);
    return ReadExif(path_, {300, 200}).value().focal_px;
  }

  std::string path_ = (fs::temp_directory_path() /
                       ("lowlap_exif_" + std::to_string(::getpid()) + ".jpg"))
                          .string();
};

TEST_F(ExifTest, FilmEquivalentGoesByTheDiagonal) {
  EXPECT_NEAR(*FocalPx({{EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, 24}}), 200, 1e-9);
}

TEST_F(ExifTest, SensorResolutionIsScaledToTheImage) {
  // 20 mm, 3000 pixels per inch, taken at 3000 pixels, shrunk to 300.
  const std::map<ExifTag, double> inches = {
      {EXIF_TAG_FOCAL_LENGTH, 20},
      {EXIF_TAG_FOCAL_PLANE_X_RESOLUTION, 3000},
      {EXIF_TAG_FOCAL_PLANE_RESOLUTION_UNIT, 2},
      {EXIF_TAG_PIXEL_X_DIMENSION, 3000},
      {EXIF_TAG_PIXEL_Y_DIMENSION, 2000}};
  const double expected_px = 20 * 3000 / 25.4 / 10;
  EXPECT_NEAR(*FocalPx(inches), expected_px, 1e-9);
  auto centimetres = inches;
  centimetres[EXIF_TAG_FOCAL_PLANE_RESOLUTION_UNIT] = 3;
  EXPECT_NEAR(*FocalPx(centimetres), expected_px * 2.54, 1e-9);
  // A film equivalent that agrees is coarser; one that does not is trusted.
  auto both = inches;
  both[EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM] = 28;
  EXPECT_NEAR(*FocalPx(both), expected_px, 1e-9);
  both[EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM] = 48;
  EXPECT_NEAR(*FocalPx(both), 400, 1e-9);
  both[EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM] = 3000;  // no lens has it
  EXPECT_NEAR(*FocalPx(both), expected_px, 1e-9);
}

TEST_F(ExifTest, WithoutUsefulDataThereIsNone) {
  EXPECT_EQ(FocalPx({}), std::nullopt);
  EXPECT_EQ(FocalPx({{EXIF_TAG_FOCAL_LENGTH, 20}}), std::nullopt);
  EXPECT_EQ(FocalPx({{EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, 0}}), std::nullopt);
  // 72 dots per inch are a print's; the film equivalent is trusted beside them.
  std::map<ExifTag, double> print = {{EXIF_TAG_FOCAL_LENGTH, 20},
                                     {EXIF_TAG_FOCAL_PLANE_X_RESOLUTION, 72},
                                     {EXIF_TAG_PIXEL_X_DIMENSION, 600}};
  EXPECT_EQ(FocalPx(print), std::nullopt);
  print[EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM] = 48;
  EXPECT_NEAR(*FocalPx(print), 400, 1e-9);
  EXPECT_EQ(FocalPx({{EXIF_TAG_FOCAL_LENGTH_IN_35MM_FILM, 3000}}),
            std::nullopt);
  EXPECT_THAT(ReadExif("no/such/file.jpg", {300, 200}),
              IsError(ErrorCode::kNotFound, "no/such/file.jpg"));
}

TEST_F(ExifTest, OrientationAndTheSizeAsTakenAreRead) {
  EXPECT_FALSE(FocalPx({{EXIF_TAG_ORIENTATION, 6},
                        {EXIF_TAG_PIXEL_X_DIMENSION, 3000},
                        {EXIF_TAG_PIXEL_Y_DIMENSION, 2000}}));
  const auto geometry = ReadExif(path_, {300, 200});
  ASSERT_TRUE(geometry);
  EXPECT_EQ(geometry->orientation, 6);
  EXPECT_EQ(geometry->taken.width_px, 3000);
  EXPECT_EQ(geometry->taken.height_px, 2000);
  EXPECT_FALSE(FocalPx({}));
  EXPECT_EQ(ReadExif(path_, {300, 200})->orientation, 1);
}

}  // namespace
}  // namespace lowlap
