#include "lowlap/features/internal/lines/line_detector.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::ExpectRefused;
using testing::IsError;
using testing::IsOk;
using testing::LeftOf;
using testing::PolygonCover;
using testing::Render;
using testing::Turned;
using testing::Uniform;

// A bright quadrilateral without special angles.
std::vector<Vec2> Corners() {
  return {Vec2(41.3, 170.2), Vec2(241.7, 201.9), Vec2(268.4, 50.6),
          Vec2(62.8, 33.1)};
}

GrayImage Quadrilateral(double blur_px, double noise_stddev,
                        std::uint64_t seed = 1) {
  return Render(
      320, 240,
      [=](const Vec2& p) {
        return 70 + 120 * PolygonCover(p, Corners(), blur_px);
      },
      noise_stddev, seed);
}

// Largest distance of the end points of the segment from an edge's line.
double Offset(const LineSegment& segment, const Vec2& start, const Vec2& end) {
  return std::max(std::abs(LeftOf(segment.start_px, start, end)),
                  std::abs(LeftOf(segment.end_px, start, end)));
}

// The segment on an edge, in its direction; nullptr if there is none.
const LineSegment* FindOn(const std::vector<LineSegment>& segments,
                          const Vec2& start, const Vec2& end,
                          double max_offset_px) {
  for (const LineSegment& s : segments) {
    if (Offset(s, start, end) < max_offset_px &&
        (s.end_px - s.start_px).dot(end - start) > 0) {
      return &s;
    }
  }
  return nullptr;
}

TEST(DetectLinesTest, FindsEdgesAtTheirSubPixelPlaceWithTheBrightSideLeft) {
  const auto segments = DetectLines(Quadrilateral(0.8, 0), {});
  ASSERT_THAT(segments, IsOk());
  EXPECT_EQ(segments->size(), 4u);
  const std::vector<Vec2> corners = Corners();
  for (int i = 0; i < 4; ++i) {
    const Vec2& start = corners[i];
    const Vec2& end = corners[(i + 1) % 4];
    const LineSegment* s = FindOn(*segments, start, end, 0.05);
    ASSERT_NE(s, nullptr) << "edge " << i;
    EXPECT_LT((s->start_px - start).norm(), 4);
    EXPECT_LT((s->end_px - end).norm(), 4);
    EXPECT_LT(s->stddev_px, 0.1);
  }
}

TEST(DetectLinesTest, NoiseAndBlurMoveEdgesByTheStatedDeviation) {
  const std::vector<Vec2> corners = Corners();
  double squares = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto segments = DetectLines(Quadrilateral(1.5, 8, seed), {});
    ASSERT_THAT(segments, IsOk());
    for (int i = 0; i < 4; ++i) {
      const Vec2& start = corners[i];
      const Vec2& end = corners[(i + 1) % 4];
      const LineSegment* s = FindOn(*segments, start, end, 1.0);
      ASSERT_NE(s, nullptr) << "edge " << i << " seed " << seed;
      const double offset = Offset(*s, start, end);
      EXPECT_LT(offset, 0.5);
      squares += offset * offset / (s->stddev_px * s->stddev_px);
      ++count;
    }
  }
  // Of two ends the worse is taken, hence somewhat above 1.
  const double ratio = std::sqrt(squares / count);
  EXPECT_GT(ratio, 0.4);
  EXPECT_LT(ratio, 2.0);
}

TEST(DetectLinesTest, ATurnedImageHasTurnedSegments) {
  const GrayImage image = Quadrilateral(1.0, 0);
  const auto turned = DetectLines(Turned(image), {});
  ASSERT_THAT(turned, IsOk());
  EXPECT_EQ(turned->size(), 4u);
  const auto turn = [&](const Vec2& p) {
    return Vec2(image.height - 1 - p.y(), p.x());
  };
  const std::vector<Vec2> corners = Corners();
  for (int i = 0; i < 4; ++i) {
    EXPECT_NE(
        FindOn(*turned, turn(corners[i]), turn(corners[(i + 1) % 4]), 0.05),
        nullptr)
        << "edge " << i;
  }
}

TEST(DetectLinesTest, ABlurredEdgeIsFoundOnACoarseLevelAndPlacedRight) {
  const Vec2 start(150.4, 700.2), end(1500.7, 300.9);
  const GrayImage image = Render(
      1700, 1000,
      [&](const Vec2& p) {
        return 60 + 130 * 0.5 * (1 + std::erf(LeftOf(p, start, end) / 9));
      },
      2.0);
  const auto segments = DetectLines(image, {});
  ASSERT_THAT(segments, IsOk());
  ASSERT_FALSE(segments->empty());
  EXPECT_GT(segments->front().LengthPx(), 1200);
  EXPECT_LT(Offset(segments->front(), start, end), 0.3);
}

TEST(DetectLinesTest, PiecesOfABrokenEdgeAreOneSegment) {
  // Dark bars cross the edge every 150 pixels.
  const Vec2 start(100, 620.3), end(1500, 480.8);
  const GrayImage image = Render(1600, 1100, [&](const Vec2& p) {
    if (std::fmod(p.x(), 150.0) < 6) return 20.0;
    return 90 + 100 * 0.5 * (1 + std::erf(LeftOf(p, start, end)));
  });
  const auto segments = DetectLines(image, {});
  ASSERT_THAT(segments, IsOk());
  const LineSegment* s = FindOn(*segments, start, end, 0.2);
  ASSERT_NE(s, nullptr);
  EXPECT_GT(s->LengthPx(), 1000);
}

TEST(DetectLinesTest, ParallelEdgesAFewPixelsApartStayApart) {
  // A bright strip of 7 pixels: two edges of opposite polarity, and a step on
  // one side makes a third of the first one's polarity.
  const GrayImage image = Render(1400, 900, [](const Vec2& p) {
    if (p.y() < 400) return 60.0;
    if (p.y() < 407) return 120.0;
    return 200.0;
  });
  const auto segments = DetectLines(image, {});
  ASSERT_THAT(segments, IsOk());
  int upper = 0, lower = 0;
  for (const LineSegment& s : *segments) {
    if (s.LengthPx() < 500) continue;
    upper += std::abs(s.start_px.y() - 399.5) < 0.6;
    lower += std::abs(s.start_px.y() - 406.5) < 0.6;
  }
  EXPECT_GE(upper, 1);
  EXPECT_GE(lower, 1);
}

TEST(DetectLinesTest, ShortSegmentsAreDroppedRelativeToTheImage) {
  LineOptions options;
  options.min_length_ratio = 0.6;  // of (320 + 240) / 2
  const auto segments = DetectLines(Quadrilateral(0.8, 0), options);
  ASSERT_THAT(segments, IsOk());
  EXPECT_EQ(segments->size(), 2u);
  for (const LineSegment& s : *segments) EXPECT_GE(s.LengthPx(), 168);
}

TEST(DetectLinesTest, SortedFromLongToShortAndLimited) {
  LineOptions options;
  options.max_segments = 3;
  const auto segments = DetectLines(Quadrilateral(0.8, 0), options);
  ASSERT_THAT(segments, IsOk());
  ASSERT_EQ(segments->size(), 3u);
  EXPECT_GE((*segments)[0].LengthPx(), (*segments)[1].LengthPx());
  EXPECT_GE((*segments)[1].LengthPx(), (*segments)[2].LengthPx());
}

TEST(DetectLinesTest, TheSameForAnyNumberOfOpenCvThreads) {
  const GrayImage image = Quadrilateral(0.8, 12);
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const auto one = DetectLines(image, {});
  cv::setNumThreads(2);
  const auto two = DetectLines(image, {});
  cv::setNumThreads(before);
  ASSERT_THAT(one, IsOk());
  ASSERT_THAT(two, IsOk());
  EXPECT_EQ(*one, *two);
}

TEST(DetectLinesTest, ImagesWithoutEdgesHaveNoSegments) {
  for (const GrayImage& image : {Uniform(100, 80, 255), Uniform(1, 1, 128),
                                 Uniform(1, 200, 128), Uniform(2000, 17, 90)}) {
    const auto segments = DetectLines(image, {});
    ASSERT_THAT(segments, IsOk());
    EXPECT_TRUE(segments->empty());
  }
}

TEST(DetectLinesTest, RejectsAnEmptyImageAndBadOptions) {
  EXPECT_THAT(DetectLines(GrayImage{}, {}),
              IsError(ErrorCode::kInvalidArgument, "0 x 0"));
  ExpectRefused(&LineOptions::min_length_ratio, 1, "min_length_ratio");
  ExpectRefused(&LineOptions::coarsest_side_px, 0, "coarsest_side_px");
  ExpectRefused(&LineOptions::max_segments, 0, "max_segments");
}

}  // namespace
}  // namespace lowlap
