#include "lowlap/matching/internal/lines/line_matching.h"

#include <gmock/gmock.h>

#include "lowlap/features/internal/lines/line_detector.h"
#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::ExpectRefused;
using ::testing::IsEmpty;
using testing::PolygonCover;
using testing::Render;

// Many quadrilaterals of random shape and brightness, at every place of which
// the grey value can be told.
class PolygonScene {
 public:
  explicit PolygonScene(std::uint64_t seed) {
    Random random(seed);
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column < 6; ++column) {
        const Vec2 center(60 + 75 * column, 55 + 75 * row);
        std::vector<Vec2> corners;
        for (int k = 0; k < 4; ++k) {
          // Angles fall: the inside is on the left as seen in the image.
          const double angle = -kPi / 2 * k + random.Uniform(0, 0.9);
          const double radius = random.Uniform(20, 36);
          corners.push_back(center +
                            radius * Vec2(std::cos(angle), std::sin(angle)));
        }
        polygons_.push_back({corners, random.Uniform(-90, 90)});
      }
    }
  }

  double operator()(const Vec2& p) const {
    double value = 120;
    for (const Polygon& polygon : polygons_) {
      if ((p - polygon.corners[0]).norm() > 90) continue;
      value += polygon.contrast * PolygonCover(p, polygon.corners, 0.8);
    }
    return value;
  }

 private:
  struct Polygon {
    std::vector<Vec2> corners;
    double contrast;
  };
  std::vector<Polygon> polygons_;
};

struct Lines {
  std::vector<LineSegment> segments;
  std::vector<LineDescriptor> descriptors;
};

Lines DetectAndDescribe(const GrayImage& image) {
  Lines lines;
  LineOptions options;
  options.min_length_ratio = 0.04;
  lines.segments = *DetectLines(image, options);
  lines.descriptors = *DescribeLines(image, lines.segments);
  return lines;
}

Vec2 Apply(const Mat3& homography, const Vec2& p) {
  return (homography * p.homogeneous()).hnormalized();
}

double ShareOfRightMatches(const Lines& first, const Lines& second,
                           const Mat3& first_from_second,
                           const std::vector<FeatureMatch>& matches) {
  int right = 0;
  for (const FeatureMatch& match : matches) {
    const LineSegment& a = first.segments[match.first];
    const LineSegment& b = second.segments[match.second];
    right += std::abs(testing::LeftOf(Apply(first_from_second, b.start_px),
                                      a.start_px, a.end_px)) < 2 &&
             std::abs(testing::LeftOf(Apply(first_from_second, b.end_px),
                                      a.start_px, a.end_px)) < 2 &&
             (Apply(first_from_second, 0.5 * (b.start_px + b.end_px)) -
              0.5 * (a.start_px + a.end_px))
                     .norm() < 0.5 * a.LengthPx();
  }
  return right / static_cast<double>(matches.size());
}

TEST(MatchLinesTest, AnImageMatchesItself) {
  const Lines lines = DetectAndDescribe(Render(480, 400, PolygonScene(1)));
  ASSERT_GT(lines.segments.size(), 80u);
  const auto matches = MatchLines({lines.segments, lines.descriptors},
                                  {lines.segments, lines.descriptors}, {});
  EXPECT_GT(matches.size(), 0.9 * static_cast<double>(lines.segments.size()));
  for (const FeatureMatch& match : matches) {
    EXPECT_EQ(match.first, match.second);
  }
}

TEST(MatchLinesTest, AnotherPerspectiveOfAPlaneIsMatched) {
  const PolygonScene scene(2);
  Mat3 first_from_second;
  first_from_second << 0.98, -0.12, 20, 0.1, 0.9, 5, 1e-4, -2e-4, 1;
  const Lines first = DetectAndDescribe(Render(480, 400, scene, 2, 1));
  const Lines second = DetectAndDescribe(Render(
      480, 400,
      [&](const Vec2& p) { return scene(Apply(first_from_second, p)); }, 2, 2));
  const auto matches = MatchLines({first.segments, first.descriptors},
                                  {second.segments, second.descriptors}, {});
  EXPECT_GT(matches.size(), 30u);
  EXPECT_GT(ShareOfRightMatches(first, second, first_from_second, matches),
            0.95);
}

TEST(MatchLinesTest, AQuarterTurnIsMatched) {
  const GrayImage image = Render(480, 400, PolygonScene(3));
  const Lines first = DetectAndDescribe(image);
  const Lines second = DetectAndDescribe(testing::Turned(image));
  const auto matches = MatchLines({first.segments, first.descriptors},
                                  {second.segments, second.descriptors}, {});
  Mat3 first_from_second;  // (x, y) = (y', h - 1 - x')
  first_from_second << 0, 1, 0, -1, 0, image.height - 1, 0, 0, 1;
  EXPECT_GT(matches.size(), 60u);
  EXPECT_GT(ShareOfRightMatches(first, second, first_from_second, matches),
            0.98);
}

TEST(MatchLinesTest, EverySegmentAtMostOnceAndSorted) {
  const PolygonScene scene(4);
  const Lines first = DetectAndDescribe(Render(480, 400, scene, 6, 1));
  const Lines second = DetectAndDescribe(Render(480, 400, scene, 6, 2));
  const auto matches = MatchLines({first.segments, first.descriptors},
                                  {second.segments, second.descriptors}, {});
  std::vector<bool> used(second.segments.size());
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (i > 0) {
      EXPECT_LT(matches[i - 1].first, matches[i].first);
    }
    EXPECT_FALSE(used[matches[i].second]);
    used[matches[i].second] = true;
  }
}

TEST(MatchLinesTest, UnrelatedImagesHardlyMatch) {
  const Lines first = DetectAndDescribe(Render(480, 400, PolygonScene(5)));
  const Lines second = DetectAndDescribe(Render(480, 400, PolygonScene(6)));
  const auto matches = MatchLines({first.segments, first.descriptors},
                                  {second.segments, second.descriptors}, {});
  EXPECT_LT(matches.size(), 0.3 * static_cast<double>(first.segments.size()));
}

TEST(MatchLinesTest, NoSegmentsOrALonelyOneHaveNoMatches) {
  const Lines none;
  Lines one;
  one.segments.resize(1);
  one.segments[0].end_px = Vec2(30, 4);
  one.descriptors.resize(1);
  const auto view = [](const Lines& lines) {
    return DescribedLines{lines.segments, lines.descriptors};
  };
  EXPECT_THAT(MatchLines(view(none), view(none), {}), IsEmpty());
  EXPECT_THAT(MatchLines(view(one), view(none), {}), IsEmpty());
  // Nothing around it confirms the match.
  EXPECT_THAT(MatchLines(view(one), view(one), {}), IsEmpty());
}

TEST(LineMatchOptionsTest, RejectsBadValues) {
  ExpectRefused(&LineMatchOptions::max_distance_bits, 300, "max_distance_bits");
  ExpectRefused(&LineMatchOptions::max_candidates, 0, "max_candidates");
  ExpectRefused(&LineMatchOptions::min_score, 2, "min_score");
  ExpectRefused(&LineMatchOptions::max_length_ratio, 0.5, "max_length_ratio");
}

}  // namespace
}  // namespace lowlap
