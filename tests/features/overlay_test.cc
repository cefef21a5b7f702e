#include "lowlap/features/internal/overlay.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::Uniform;

bool IsGray(const cv::Vec3b& color) {
  return color[0] == color[1] && color[1] == color[2];
}

TEST(WriteOverlayTest, DrawsSegmentsAndPointsWhereTheyAre) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("lowlap_overlay_" + std::to_string(::getpid()) + ".png");
  ViewFeatures features;
  features.points_px = {Vec2(20, 30)};
  LineSegment segment;
  segment.start_px = Vec2(50, 60);
  segment.end_px = Vec2(90, 60);
  features.segments = {segment};
  ASSERT_THAT(WriteOverlay(Uniform(120, 100, 128), features, path.string()),
              IsOk());
  const cv::Mat drawn = cv::imread(path.string(), cv::IMREAD_COLOR);
  std::filesystem::remove(path);
  ASSERT_EQ(drawn.cols, 120);
  ASSERT_EQ(drawn.rows, 100);
  EXPECT_FALSE(IsGray(drawn.at<cv::Vec3b>(30, 20)));
  for (const int x : {50, 70, 90}) {
    EXPECT_FALSE(IsGray(drawn.at<cv::Vec3b>(60, x))) << x;
  }
  EXPECT_TRUE(IsGray(drawn.at<cv::Vec3b>(60, 40)));
  EXPECT_TRUE(IsGray(drawn.at<cv::Vec3b>(70, 70)));
}

TEST(WriteOverlayTest, NamesAFolderThatIsNotThere) {
  EXPECT_THAT(WriteOverlay(Uniform(20, 20, 9), {}, "none/here.png"),
              IsError(ErrorCode::kIo, "none"));
}

}  // namespace
}  // namespace lowlap
