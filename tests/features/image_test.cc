#include "lowlap/features/internal/image.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "lowlap/features/internal/thumbnail.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

class ImageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(::testing::TempDir()) /
        ("lowlap_image_" +
         std::string(
             ::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const {
    return (folder_ / name).string();
  }
  std::string WriteBytes(const std::string& name, const std::string& bytes) {
    std::ofstream(Path(name), std::ios::binary) << bytes;
    return Path(name);
  }

  std::filesystem::path folder_;
};

TEST_F(ImageTest, ReadsGreyPixelsRowByRow) {
  cv::Mat mat(3, 5, CV_8UC1);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      mat.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(10 * y + x);
    }
  }
  cv::imwrite(Path("a.png"), mat);
  const Result<GrayImage> image = ReadGrayImage(Path("a.png"));
  ASSERT_THAT(image, IsOk());
  EXPECT_EQ(image->width, 5);
  EXPECT_EQ(image->height, 3);
  ASSERT_THAT(image->Validate(), IsOk());
  EXPECT_EQ(image->pixels[7], 12);
}

TEST_F(ImageTest, ConvertsColourToGrey) {
  cv::imwrite(Path("a.png"), cv::Mat(2, 2, CV_8UC3, cv::Scalar(0, 255, 0)));
  const Result<GrayImage> image = ReadGrayImage(Path("a.png"));
  ASSERT_THAT(image, IsOk());
  EXPECT_NEAR(image->pixels[0], 150, 1);
}

TEST_F(ImageTest, SizeAgreesWithTheDecodedImageInEveryFormat) {
  const cv::Mat mat(17, 300, CV_8UC3, cv::Scalar(10, 20, 30));
  for (const std::string name :
       {"a.png", "a.jpg", "a.bmp", "a.tif", "a.webp", "a.ppm"}) {
    SCOPED_TRACE(name);
    cv::imwrite(Path(name), mat);
    const Result<ImageSize> size = ReadImageSize(Path(name));
    ASSERT_THAT(size, IsOk());
    EXPECT_EQ(size->width_px, 300);
    EXPECT_EQ(size->height_px, 17);
    EXPECT_THAT(ReadGrayImage(Path(name)), IsOk());
  }
}

// OpenCV throws for a longer side, and its message means nothing to a user.
TEST_F(ImageTest, RefusesAnImageThatIsTooLong) {
  std::vector<std::uint8_t> bmp;
  cv::imencode(".bmp", cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3)), bmp);
  bmp.at(22) = 0, bmp.at(23) = 0, bmp.at(24) = 0x11;  // the height
  const std::string bytes(bmp.begin(), bmp.end());
  for (const Status& read :
       {Status(DecodeImageSize(bytes, "a.bmp").map([](auto&&) {})),
        Status(DecodeGrayImage(bytes, "a.bmp").map([](auto&&) {})),
        Status(MakeThumbnail(bytes, 64, "a.bmp").map([](auto&&) {}))}) {
    ASSERT_THAT(read, IsError(ErrorCode::kUnsupported,
                              "an image of 2 x 1114112 pixels; a side of "
                              "1048576 is the most"));
    EXPECT_EQ(read.error().file, "a.bmp");
  }
}

TEST_F(ImageTest, NamesAMissingFile) {
  EXPECT_THAT(ReadGrayImage(Path("none.jpg")),
              IsError(ErrorCode::kNotFound, "none.jpg"));
  EXPECT_THAT(ReadImageSize(Path("none.jpg")),
              IsError(ErrorCode::kNotFound, "none.jpg"));
}

TEST_F(ImageTest, NamesAFileThatIsNoImage) {
  for (const std::string& bytes :
       {std::string(), std::string("K.txt 1 0 0"), std::string("\xff\xd8"),
        std::string("\xff\xd8\xff\xe0"), std::string("\x89PNG\r\n\x1a\n"),
        std::string("RIFF"), std::string("II*\0\xff\xff\xff\xff", 8),
        std::string("P5 7"), std::string("BM")}) {
    const std::string path = WriteBytes("bad.jpg", bytes);
    EXPECT_THAT(ReadGrayImage(path), IsError(ErrorCode::kParse, "bad.jpg"));
    EXPECT_THAT(ReadImageSize(path), IsError(ErrorCode::kParse, "bad.jpg"));
  }
}

TEST_F(ImageTest, AJpegCutAnywhereIsNeverACrash) {
  cv::imwrite(Path("a.jpg"), cv::Mat(8, 8, CV_8UC1, cv::Scalar(77)));
  std::ifstream stream(Path("a.jpg"), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    const std::string path = WriteBytes("cut.jpg", bytes.substr(0, length));
    const Result<ImageSize> size = ReadImageSize(path);
    EXPECT_THAT(size, IsError(ErrorCode::kParse, "cut.jpg"));
    EXPECT_THAT(ReadGrayImage(path), IsError(ErrorCode::kParse, "cut.jpg"));
  }
}

TEST_F(ImageTest, AJpegMayEndWithAShortSegment) {
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", cv::Mat(8, 8, CV_8UC1, cv::Scalar(77)), jpeg);
  std::string bytes(jpeg.begin(), jpeg.end());
  bytes.insert(bytes.size() - 2, std::string("\xff\xfe\0\3a", 5));
  EXPECT_THAT(DecodeGrayImage(bytes, "a.jpg"), IsOk());
}

TEST_F(ImageTest, ATiffIsReadAsStoredWhateverItsOrientation) {
  cv::Mat stored(3, 5, CV_8UC1);
  for (int n = 0; n < 15; ++n) stored.data[n] = static_cast<uchar>(10 * n);
  std::vector<std::uint8_t> tiff;
  cv::imencode(".tif", stored, tiff, {cv::IMWRITE_TIFF_COMPRESSION, 1});
  std::string bytes(tiff.begin(), tiff.end());
  // The tag of the samples per pixel (one by default) becomes the orientation.
  const std::size_t tag = bytes.find(std::string("\x15\x01\3\0\1\0\0\0", 8));
  ASSERT_NE(tag, std::string::npos);
  bytes[tag] = '\x12';
  for (char orientation = 1; orientation <= 8; ++orientation) {
    SCOPED_TRACE(static_cast<int>(orientation));
    bytes[tag + 8] = orientation;
    const Result<GrayImage> image = DecodeGrayImage(bytes, "a.tif");
    ASSERT_THAT(image, IsOk());
    EXPECT_EQ(image->width, 5);
    EXPECT_EQ(image->height, 3);
    EXPECT_EQ(image->pixels, std::vector<std::uint8_t>(stored.begin<uchar>(),
                                                       stored.end<uchar>()));
  }
}

TEST_F(ImageTest, AJpegIsWholeOnlyWithItsOwnEnd) {
  // Noise: coded data with every byte value in them. The end of a thumbnail
  // inside a segment is not that of the image.
  cv::Mat noise(64, 64, CV_8UC1);
  cv::randu(noise, 0, 256);
  const std::string thumbnail("\xff\xe1\x00\x06\xff\xd9\xff\xd9", 8);
  for (const int progressive : {0, 1}) {
    cv::imwrite(Path("a.jpg"), noise,
                {cv::IMWRITE_JPEG_PROGRESSIVE, progressive,
                 cv::IMWRITE_JPEG_RST_INTERVAL, 2});
    std::ifstream stream(Path("a.jpg"), std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    bytes.insert(2, thumbnail);
    EXPECT_THAT(ReadGrayImage(WriteBytes("whole.jpg", bytes + "more")), IsOk());
    // Decoders skip what lies between segments; the first is at 2.
    const std::size_t next = 4 + 256 * static_cast<unsigned char>(bytes[4]) +
                             static_cast<unsigned char>(bytes[5]);
    std::string padded = bytes;
    padded.insert(next, std::string("\1\2\xff\0\3\xff\xd3", 7));
    EXPECT_THAT(ReadGrayImage(WriteBytes("padded.jpg", padded)), IsOk());
    EXPECT_THAT(ReadGrayImage(
                    WriteBytes("half.jpg", bytes.substr(0, bytes.size() / 2))),
                IsError(ErrorCode::kParse, "cut off"));
  }
}

TEST_F(ImageTest, AnImageTooLargeIsRefusedBeforeItIsDecoded) {
  // Only the heads: were they decoded, it would fail for want of an image.
  const std::string side("\x00\x00\x7d\x00", 4);  // 32000
  const std::string png = std::string("\x89PNG\r\n\x1a\n") +
                          std::string("\x00\x00\x00\x0dIHDR", 8) + side + side +
                          std::string("\x08\x00\x00\x00\x00", 5);
  std::string bmp("BM");
  bmp += std::string(16, '\0') + std::string("\x00\x7d\x00\x00", 4) +
         std::string("\x00\x7d\x00\x00", 4) + std::string(28, '\0');
  std::string tiff("II*\0\x08\0\0\0\x02\0", 10);
  for (const char tag : {'\0', '\1'}) {  // 256, 257: width, height
    tiff += std::string(1, tag) + std::string("\x01\x04\0\x01\0\0\0", 7) +
            std::string("\x00\x7d\x00\x00", 4);
  }
  const std::string webp = std::string("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0", 20) +
                           std::string(4, '\0') +
                           std::string("\xff\x7c\0\xff\x7c\0", 6);
  const std::string pgm = "P5 #32\n32000\t32000 255\n";
  for (const std::string& bytes : {png, bmp, tiff, webp, pgm}) {
    const std::string path = WriteBytes("huge.png", bytes);
    EXPECT_THAT(ReadGrayImage(path),
                IsError(ErrorCode::kUnsupported, "32000 x 32000"));
    EXPECT_THAT(ReadImageSize(path),
                IsError(ErrorCode::kUnsupported, "32000 x 32000"));
  }
}

TEST(GrayImageTest, ValidateFindsWrongSizes) {
  GrayImage image;
  EXPECT_THAT(image.Validate(), IsError(ErrorCode::kInvalidArgument, "0 x 0"));
  image.width = 3;
  image.height = 2;
  image.pixels.resize(5);
  EXPECT_THAT(image.Validate(),
              IsError(ErrorCode::kInvalidArgument, "5 pixels"));
  image.pixels.resize(6);
  EXPECT_THAT(image.Validate(), IsOk());
}

}  // namespace
}  // namespace lowlap
