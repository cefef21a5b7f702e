#include "third_party_adapters/strecha/internal/strecha.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/temporary_folder.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap::strecha {
namespace {

using ::testing::HasSubstr;

// Camera 0000 of fountain-P11, as distributed.
constexpr char kCamera[] =
    "2759.48 0 1520.69 \n0 2764.16 1006.81 \n0 0 1 \n0 0 0\n"
    "0.450927 -0.0945642 -0.887537 \n-0.892535 -0.0401974 -0.449183 \n"
    "0.00679989 0.994707 -0.102528 \n-7.28137 -7.57667 0.204446 \n"
    "3072 2048\n";

TEST(Strecha, ReadsCalibrationMatricesAsProgramsWriteThem) {
  for (const char* text :
       {"487.5,0,299.5\n0,487,199.5\n0,0,1\n",
        "[[487.5, 0, 299.5],\n [0, 487, 199.5],\n [0, 0, 1]]",
        "[487.5 0 299.5; 0 487 199.5; 0 0 1]",
        "# fx 0 cx, 1\n487.5 0 299.5\n0 487 199.5\n0 0 1",
        "\xef\xbb\xbf"
        "487.5 0 299.5 0 487 199.5 0 0 1"}) {
    const Result<Mat3> k = ParseCalibrationMatrix(text, "K.txt");
    ASSERT_TRUE(k) << text << ": " << k.error().ToString();
    EXPECT_EQ((*k)(0, 0), 487.5);
    EXPECT_EQ((*k)(1, 2), 199.5);
  }
  // Decimal commas.
  for (const char* text : {"487,5 0 299,5 0 487,5 199,5 0 0 1",
                           "PINHOLE 600 400 487.5 487.5 299.5 199.5"}) {
    const Result<Mat3> k = ParseCalibrationMatrix(text, "K.txt");
    ASSERT_FALSE(k);
    EXPECT_NE(k.error().message.find("fx 0 cx / 0 fy cy / 0 0 1"),
              std::string::npos);
  }
}

TEST(Strecha, ReadsACalibrationMatrixWithTwoFocalLengths) {
  for (const char* text :
       {"2759.48 0 1520.69 \n0 2764.16 1006.81 \n0 0 1 ",
        "2759.48\t0 1520.69\r\n0 2764.16 1006.81\r\n0 0 1.0\r\n\r\n"}) {
    const Result<Mat3> k = ParseCalibrationMatrix(text);
    ASSERT_TRUE(k.has_value()) << k.error().ToString();
    const Intrinsic intrinsic = PinholeFromMatrix(*k, 3072, 2048);
    EXPECT_EQ(intrinsic.model, CameraModel::kPinhole);
    EXPECT_EQ(intrinsic.fx_px, 2759.48);
    EXPECT_EQ(intrinsic.fy_px, 2764.16);
    EXPECT_EQ(intrinsic.principal_point_px, Vec2(1520.69, 1006.81));
    EXPECT_EQ(intrinsic.width_px, 3072);
    EXPECT_TRUE(intrinsic.Validate().has_value());
  }
}

TEST(Strecha, RefusesOtherMatricesByName) {
  const auto error = [](const char* text) {
    const Result<Mat3> k = ParseCalibrationMatrix(text, "K.txt");
    EXPECT_FALSE(k.has_value()) << text;
    return k ? Error() : k.error();
  };
  EXPECT_THAT(error("9 0.1 5\n0 9 5\n0 0 1").message, HasSubstr("skew"));
  EXPECT_THAT(error("9 0 5\n0 9 5\n0 0 2").message, HasSubstr("0 0 1"));
  EXPECT_THAT(error("9 0 5\n0 9 5\n0 1 1").message, HasSubstr("0 0 1"));
  EXPECT_THAT(error("9 0 5\n0 -9 5\n0 0 1").message, HasSubstr("positive"));
  EXPECT_THAT(error("9 0 5\n0 9 5\n0 0").message, HasSubstr("9 numbers"));
  EXPECT_THAT(error("9 0 5\n0 9 5\n0 0 1\n7").ToString(), HasSubstr("line 4"));
  EXPECT_THAT(error("9 0 5\n0 a 5\n0 0 1").ToString(),
              HasSubstr("K.txt: line 2: 'a'"));
  EXPECT_THAT(error("9 0 inf\n0 9 5\n0 0 1").ToString(), HasSubstr("'inf'"));
  EXPECT_THAT(error("").message, HasSubstr("not 0"));
}

TEST(Strecha, TheStoredRotationIsFromCameraToWorld) {
  const Result<Camera> camera = ParseCamera(kCamera);
  ASSERT_TRUE(camera.has_value()) << camera.error().ToString();
  EXPECT_EQ(camera->intrinsic.fy_px, 2764.16);
  EXPECT_EQ(camera->intrinsic.width_px, 3072);
  EXPECT_EQ(camera->intrinsic.height_px, 2048);
  EXPECT_EQ(camera->pose.center, Vec3(-7.28137, -7.57667, 0.204446));
  // The third stored column is the viewing direction, the second one down.
  EXPECT_LT((camera->pose.rotation.row(2).transpose() -
             Vec3(-0.887537, -0.449183, -0.102528))
                .norm(),
            2e-6);
  EXPECT_LT((camera->pose.rotation.row(1).transpose() -
             Vec3(-0.0945642, -0.0401974, 0.994707))
                .norm(),
            2e-6);
  EXPECT_LT(RotationDefect(camera->pose.rotation), 1e-12);
}

TEST(Strecha, MalformedCamerasAreNamed) {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string text = kCamera;
    text.replace(text.find(from), from.size(), to);
    const Result<Camera> camera = ParseCamera(text, "0000.jpg.camera");
    EXPECT_FALSE(camera.has_value()) << to;
    return camera ? std::string() : camera.error().ToString();
  };
  EXPECT_THAT(error("0.994707", "-0.994707"), HasSubstr("rotation"));
  EXPECT_THAT(error("3072 2048", "3072"), HasSubstr("26 numbers"));
  EXPECT_THAT(error("3072 2048", "30.5 2048"), HasSubstr("image size"));
  EXPECT_THAT(error("3072 2048", "0 2048"), HasSubstr("image size"));
  EXPECT_THAT(error("0 0 0\n", "0 1 0\n"), HasSubstr("0 0 0"));
  EXPECT_THAT(error("-7.57667", "x"), HasSubstr("line 8: 'x'"));
  EXPECT_THAT(error("2759.48 0", "2759.48 2"), HasSubstr("skew"));
}

TEST(Strecha, EveryTruncationToWholeNumbersIsAnError) {
  const std::string text = kCamera;
  for (std::size_t size = 0; size < text.find("2048\n"); ++size) {
    EXPECT_FALSE(ParseCamera(text.substr(0, size)).has_value()) << size;
  }
}

TEST(Strecha, GroundTruthIsKeyedByImage) {
  const TemporaryFolder folder;
  folder.Write("gt_dense_cameras/0000.jpg.camera", kCamera);
  folder.Write("gt_dense_cameras/0001.jpg.camera", kCamera);
  folder.Write("gt_dense_cameras/readme.txt", "no camera");
  for (const std::string& dir :
       {folder.Path(), folder.Path("gt_dense_cameras")}) {
    const auto truth = ReadGroundTruth(dir);
    ASSERT_TRUE(truth.has_value()) << truth.error().ToString();
    ASSERT_EQ(truth->size(), 2u);
    EXPECT_EQ(truth->at("0001.jpg").center.x(), -7.28137);
    EXPECT_EQ(ReadCameras(dir)->at("0000.jpg").intrinsic.height_px, 2048);
  }
}

TEST(Strecha, MissingAndEmptyFoldersAreNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(ReadGroundTruth(folder.Path("none")).error().code,
            ErrorCode::kNotFound);
  EXPECT_EQ(ReadGroundTruth(folder.Path()).error().code, ErrorCode::kNotFound);
  folder.Write("0000.jpg.camera", "1 2 3");
  const auto broken = ReadGroundTruth(folder.Path());
  ASSERT_FALSE(broken.has_value());
  EXPECT_EQ(broken.error().file, folder.Path("0000.jpg.camera"));
}

}  // namespace
}  // namespace lowlap::strecha
