#include "lowlap/features/internal/overlay.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

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

cv::Mat DecodePng(const std::string& png) {
  return cv::imdecode(std::vector<char>(png.begin(), png.end()),
                      cv::IMREAD_COLOR);
}

LineSegment Segment(const Vec2& start_px, const Vec2& end_px) {
  LineSegment segment;
  segment.start_px = start_px;
  segment.end_px = end_px;
  return segment;
}

double Saturation(const cv::Vec3b& color) {
  const auto [least, most] = std::minmax({color[0], color[1], color[2]});
  return most - least;
}

TEST(DrawInliersTest, MakesThemBrightAtTheirPlacesInTheSmallerPicture) {
  ViewFeatures features;
  features.points_px = {Vec2(40, 60), Vec2(160, 60)};
  features.segments = {Segment({40, 120}, {80, 120}),
                       Segment({120, 120}, {180, 120})};
  const auto png = DrawInliers(Uniform(200, 160, 128), features, {1}, {0}, 100);
  ASSERT_THAT(png, IsOk());
  const cv::Mat drawn = DecodePng(*png);
  ASSERT_EQ(drawn.cols, 100);
  ASSERT_EQ(drawn.rows, 80);
  EXPECT_GT(Saturation(drawn.at<cv::Vec3b>(30, 80)), 100);
  EXPECT_LT(Saturation(drawn.at<cv::Vec3b>(30, 20)), 50);
  EXPECT_FALSE(IsGray(drawn.at<cv::Vec3b>(30, 20)));
  EXPECT_GT(Saturation(drawn.at<cv::Vec3b>(60, 30)), 100);
  EXPECT_LT(Saturation(drawn.at<cv::Vec3b>(60, 75)), 50);
  EXPECT_TRUE(IsGray(drawn.at<cv::Vec3b>(10, 10)));
}

TEST(DrawMatchesTest, PutsBothEndsOfAMatchInOneColour) {
  ViewFeatures first, second;
  first.points_px = {Vec2(0, 0), Vec2(20, 30)};
  second.points_px = {Vec2(70, 50)};
  first.segments = {Segment({20, 70}, {60, 70})};
  second.segments = {Segment({30, 80}, {70, 80})};
  const GrayImage left = Uniform(100, 100, 128), right = Uniform(100, 90, 128);
  const auto png = DrawMatches({&left, &first}, {&right, &second},
                               {{1, 0}, {5, 0}}, {{0, 0}}, 1000);
  ASSERT_THAT(png, IsOk());
  const cv::Mat drawn = DecodePng(*png);
  ASSERT_EQ(drawn.cols, 208);  // with a gap between them
  ASSERT_EQ(drawn.rows, 100);
  EXPECT_EQ(drawn.at<cv::Vec3b>(30, 20), drawn.at<cv::Vec3b>(50, 108 + 70));
  EXPECT_EQ(drawn.at<cv::Vec3b>(70, 25), drawn.at<cv::Vec3b>(80, 108 + 35));
  EXPECT_NE(drawn.at<cv::Vec3b>(70, 25), drawn.at<cv::Vec3b>(30, 20));
  EXPECT_GT(Saturation(drawn.at<cv::Vec3b>(30, 20)), 100);
}

}  // namespace
}  // namespace lowlap
