#include "lowlap/features/internal/jpeg_damage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "lowlap/features/internal/image.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::HasSubstr;
using testing::IsError;
using testing::IsOk;

std::string Encoded(const char* format, int progressive = 0) {
  cv::Mat image(96, 128, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<cv::Vec3b>(y, x) = cv::Vec3b(
          static_cast<std::uint8_t>(x * y), static_cast<std::uint8_t>(7 * x),
          static_cast<std::uint8_t>(x * x + 3 * y));
    }
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(format, image, bytes,
               {cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
  return {bytes.begin(), bytes.end()};
}

// As a bad block of a disk leaves it: the end is there.
std::string WithZerosInTheMiddle(std::string bytes) {
  bytes.replace(bytes.size() / 2, 300, 300, '\0');
  return bytes;
}

TEST(JpegDamage, IsNoneOfWholeFilesAndOfOtherFormats) {
  for (const int progressive : {0, 1}) {
    EXPECT_EQ(JpegDamage(Encoded(".jpg", progressive)), std::nullopt);
  }
  EXPECT_EQ(JpegDamage(WithZerosInTheMiddle(Encoded(".bmp"))), std::nullopt);
  EXPECT_EQ(JpegDamage(""), std::nullopt);
}

TEST(JpegDamage, IsWhatIsLostInTheMiddle) {
  for (const int progressive : {0, 1}) {
    const auto damage =
        JpegDamage(WithZerosInTheMiddle(Encoded(".jpg", progressive)));
    ASSERT_TRUE(damage.has_value()) << progressive;
    EXPECT_THAT(*damage, HasSubstr("JPEG"));
  }
}

TEST(JpegDamage, IsNotWhatFollowsTheImage) {
  const std::string whole = Encoded(".jpg");
  const auto before_end = [&](const std::string& extra) {
    return std::string(whole).insert(whole.size() - 2, extra);
  };
  EXPECT_EQ(JpegDamage(before_end(std::string(300, '\0'))), std::nullopt);
  EXPECT_EQ(JpegDamage(before_end("few")), std::nullopt);
  EXPECT_EQ(JpegDamage(whole + "more"), std::nullopt);
  EXPECT_NE(JpegDamage(before_end(std::string(300, 'x'))), std::nullopt);
}

TEST(JpegDamage, EveryCutIsToldOrStopsTheHeader) {
  const std::string whole = Encoded(".jpg");
  for (std::size_t size = 2; size + 2 < whole.size(); size += 7) {
    EXPECT_TRUE(JpegDamage(whole.substr(0, size)).has_value()) << size;
  }
}

TEST(JpegDamage, IsAnErrorThatNamesTheFile) {
  EXPECT_THAT(DecodeGrayImage(Encoded(".jpg"), "whole.jpg"), IsOk());
  EXPECT_THAT(DecodeGrayImage(WithZerosInTheMiddle(Encoded(".jpg")), "a.jpg"),
              IsError(ErrorCode::kParse, "a.jpg: a part of the image is lost"));
}

}  // namespace
}  // namespace lowlap
