#include "lowlap/features/internal/features.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::BlobTexture;
using testing::IsError;
using testing::IsOk;
using testing::Render;
using testing::Uniform;

LineSegment Segment(double x0, double y0, double x1, double y1) {
  LineSegment segment;
  segment.start_px = Vec2(x0, y0);
  segment.end_px = Vec2(x1, y1);
  return segment;
}

int Hamming(const LineDescriptor& a, const LineDescriptor& b) {
  int distance = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    distance += __builtin_popcount(static_cast<unsigned>(a[i] ^ b[i]));
  }
  return distance;
}

TEST(DescribeLinesTest, AShiftedImageHasTheSameDescriptors) {
  const BlobTexture texture(9, 300, 260);
  const Vec2 shift(13, 8);
  const auto a =
      DescribeLines(Render(240, 220, texture),
                    {Segment(60, 70, 160, 95), Segment(180, 60, 100, 150)});
  const auto b = DescribeLines(
      Render(240, 220, [&](const Vec2& p) { return texture(p - shift); }),
      {Segment(73, 78, 173, 103), Segment(193, 68, 113, 158)});
  ASSERT_THAT(a, IsOk());
  ASSERT_THAT(b, IsOk());
  EXPECT_EQ((*a)[0], (*b)[0]);
  EXPECT_EQ((*a)[1], (*b)[1]);
  EXPECT_GT(Hamming((*a)[0], (*a)[1]), 60);
}

TEST(DescribeLinesTest, SegmentsAtTheBorderAreDescribed) {
  const GrayImage image = Render(90, 70, BlobTexture(2, 60, 90));
  const auto descriptors = DescribeLines(
      image, {Segment(0, 0, 89, 0), Segment(89, 69, 89, 0),
              Segment(-0.5, 69.5, 89.5, 69.5), Segment(3, 3, 3.2, 3)});
  ASSERT_THAT(descriptors, IsOk());
  EXPECT_EQ(descriptors->size(), 4u);
}

TEST(DescribeLinesTest, RejectsSegmentsOutside) {
  const GrayImage image = Uniform(90, 70, 100);
  EXPECT_THAT(
      DescribeLines(image, {Segment(0, 0, 5, 5), Segment(0, 0, 300, 5)}),
      IsError(ErrorCode::kInvalidArgument, "segment 1"));
  EXPECT_THAT(DescribeLines(image, {Segment(0, 0, NAN, 5)}),
              IsError(ErrorCode::kInvalidArgument, "segment 0"));
}

TEST(DescribeLinesTest, NoSegmentsNoDescriptors) {
  const auto none = DescribeLines(Uniform(1, 1, 3), {});
  ASSERT_THAT(none, IsOk());
  EXPECT_TRUE(none->empty());
}

TEST(DescribeLinesTest, AVeryLongStripIsDescribed) {
  for (const int width : {31000, 70000}) {
    const GrayImage strip = Render(
        width, 17, [](const Vec2& p) { return p.y() < 8 ? 60.0 : 200.0; });
    const auto descriptors =
        DescribeLines(strip, {Segment(width - 9000, 7.5, width - 1, 7.5)});
    ASSERT_THAT(descriptors, IsOk()) << width;
    EXPECT_EQ(descriptors->size(), 1u);
  }
}

TEST(DetectFeaturesTest, KindsCanBeLeftOut) {
  const GrayImage image = Render(160, 120, BlobTexture(3, 120, 160));
  FeatureOptions options;
  options.detect_lines = false;
  const auto points = DetectFeatures(image, options);
  ASSERT_THAT(points, IsOk());
  EXPECT_FALSE(points->features.points_px.empty());
  EXPECT_EQ(points->features.points_px.size(), points->keypoints.size());
  EXPECT_EQ(points->features.points_px.size(),
            points->point_descriptors.size());
  EXPECT_TRUE(points->features.segments.empty());
  options.detect_lines = true;
  options.detect_points = false;
  const auto lines = DetectFeatures(image, options);
  ASSERT_THAT(lines, IsOk());
  EXPECT_TRUE(lines->features.points_px.empty());
  EXPECT_EQ(lines->features.segments.size(), lines->line_descriptors.size());
}

class DetectFeaturesOfSceneTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(::testing::TempDir()) /
        ("lowlap_features_" +
         std::string(
             ::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
    scene_.root_path = folder_.string();
    for (std::uint32_t id = 0; id < 4; ++id) {
      const GrayImage image = Render(120, 90, BlobTexture(id + 1, 60, 120));
      View view;
      view.filename = std::to_string(id) + ".png";
      view.width_px = image.width;
      view.height_px = image.height;
      scene_.views[id] = view;
      cv::imwrite((folder_ / view.filename).string(),
                  cv::Mat(90, 120, CV_8UC1,
                          const_cast<std::uint8_t*>(image.pixels.data())));
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  Scene scene_;
};

TEST_F(DetectFeaturesOfSceneTest, TheSameForOneAndTwoThreads) {
  RunContext context;
  context.num_threads = 1;
  const auto one = DetectFeatures(scene_, {}, context);
  context.num_threads = 2;
  const auto two = DetectFeatures(scene_, {}, context);
  ASSERT_THAT(one, IsOk());
  ASSERT_THAT(two, IsOk());
  ASSERT_EQ(one->size(), 4u);
  for (const auto& [id, features] : *one) {
    EXPECT_FALSE(features.features.points_px.empty());
    EXPECT_EQ(features.features, two->at(id).features);
    EXPECT_EQ(features.point_descriptors, two->at(id).point_descriptors);
    EXPECT_EQ(features.line_descriptors, two->at(id).line_descriptors);
  }
}

TEST_F(DetectFeaturesOfSceneTest, NamesTheImageThatIsMissing) {
  std::filesystem::remove(folder_ / "2.png");
  EXPECT_THAT(DetectFeatures(scene_, {}, {}),
              IsError(ErrorCode::kNotFound, "2.png"));
}

TEST_F(DetectFeaturesOfSceneTest, NamesTheImageOfAnotherSize) {
  scene_.views[1].width_px = 121;
  EXPECT_THAT(DetectFeatures(scene_, {}, {}),
              IsError(ErrorCode::kInvalidScene, "121 x 90"));
}

TEST_F(DetectFeaturesOfSceneTest, StopsOnRequest) {
  RunContext context;
  context.progress = [](const std::string&, std::size_t done, std::size_t) {
    return done == 0;
  };
  EXPECT_THAT(DetectFeatures(scene_, {}, context),
              IsError(ErrorCode::kCancelled, "features"));
}

TEST_F(DetectFeaturesOfSceneTest, RejectsBadOptions) {
  FeatureOptions options;
  options.max_memory_gb = 0;
  EXPECT_THAT(DetectFeatures(scene_, options, {}),
              IsError(ErrorCode::kInvalidArgument, "max_memory_gb"));
}

}  // namespace
}  // namespace lowlap
