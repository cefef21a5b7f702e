#include "lowlap/features/internal/thumbnail.h"

#include <gmock/gmock.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;

// Green on the left, red on the right.
std::string Encoded(const char* extension, int width, int height) {
  cv::Mat image(height, width, CV_8UC3, cv::Scalar(0, 200, 0));
  image.colRange(width / 2, width) = cv::Scalar(0, 0, 200);
  std::vector<std::uint8_t> bytes;
  cv::imencode(extension, image, bytes);
  return {bytes.begin(), bytes.end()};
}

cv::Mat Decoded(const std::string& jpeg) {
  return cv::imdecode(std::vector<char>(jpeg.begin(), jpeg.end()),
                      cv::IMREAD_COLOR);
}

TEST(MakeThumbnail, IsASmallJpegOfTheSameShapeAndColours) {
  // Reduced as they are decoded by eight, four, two, and not.
  for (const int width : {4096, 2000, 1210, 700}) {
    for (const char* extension : {".jpg", ".png"}) {
      const auto jpeg =
          MakeThumbnail(Encoded(extension, width, width / 2), 480, "a");
      ASSERT_THAT(jpeg, IsOk());
      EXPECT_EQ(jpeg->substr(0, 2), "\xff\xd8");
      const cv::Mat small = Decoded(*jpeg);
      EXPECT_EQ(small.cols, 480) << width;
      EXPECT_EQ(small.rows, 240) << width;
      const cv::Vec3b left = small.at<cv::Vec3b>(120, 100);
      const cv::Vec3b right = small.at<cv::Vec3b>(120, 380);
      EXPECT_NEAR(left[1], 200, 12);
      EXPECT_NEAR(left[2], 0, 12);
      EXPECT_NEAR(right[2], 200, 12);
    }
  }
}

TEST(MakeThumbnail, LeavesSmallImagesAsTheyAre) {
  const auto jpeg = MakeThumbnail(Encoded(".png", 60, 40), 480, "a");
  ASSERT_THAT(jpeg, IsOk());
  EXPECT_EQ(Decoded(*jpeg).cols, 60);
}

TEST(MakeThumbnail, RefusesWhatIsNoImage) {
  EXPECT_THAT(MakeThumbnail("not an image", 480, "a.jpg"),
              IsError(ErrorCode::kParse, "a.jpg"));
  EXPECT_THAT(MakeThumbnail("", 480, "a.jpg"),
              IsError(ErrorCode::kParse, "a.jpg"));
  const std::string whole = Encoded(".jpg", 700, 300);
  EXPECT_THAT(MakeThumbnail(whole.substr(0, whole.size() / 2), 480, "a.jpg"),
              IsError(ErrorCode::kParse, "cut off"));
}

}  // namespace
}  // namespace lowlap
