#include "lowlap/matching/internal/points/point_matching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/matching/internal/points/nearest_two.h"
#include "support/matchers.h"
#include "support/random_vectors.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::BlobTexture;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::ExpectRefused;
using ::testing::IsEmpty;
using testing::IsError;
using testing::IsOk;
using ::testing::IsSubsetOf;
using ::testing::Not;
using testing::Render;

std::vector<PointDescriptor> RandomDescriptors(std::uint64_t seed,
                                               std::size_t count,
                                               std::uint32_t levels) {
  Random random(seed);
  std::vector<PointDescriptor> descriptors(count);
  for (PointDescriptor& descriptor : descriptors) {
    for (std::uint8_t& value : descriptor) {
      value = static_cast<std::uint8_t>(random.Index(levels));
    }
  }
  return descriptors;
}

std::int32_t SquaredDistance(const PointDescriptor& a,
                             const PointDescriptor& b) {
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const int difference = a[k] - b[k];
    sum += difference * difference;
  }
  return sum;
}

NearestTwo BruteForce(const PointDescriptor& query,
                      const std::vector<PointDescriptor>& database) {
  NearestTwo nearest;
  for (std::size_t i = 0; i < database.size(); ++i) {
    const std::int32_t distance2 = SquaredDistance(query, database[i]);
    if (distance2 < nearest.distance2) {
      nearest.second_distance2 = nearest.distance2;
      nearest.distance2 = distance2;
      nearest.index = static_cast<std::int32_t>(i);
    } else if (distance2 < nearest.second_distance2) {
      nearest.second_distance2 = distance2;
    }
  }
  return nearest;
}

TEST(FindNearestTwoTest, EqualsBruteForceForEverySizeAndWithTies) {
  for (const std::uint32_t levels : {2u, 256u}) {
    for (const std::size_t count : {0u, 1u, 2u, 15u, 16u, 17u, 33u, 700u}) {
      const auto queries = RandomDescriptors(1, 20, levels);
      auto database = RandomDescriptors(2, count, levels);
      // Two equal ones: the lower index wins.
      if (count > 16) database[16] = database[3] = queries[5];
      std::vector<std::vector<NearestTwo>> forms = {
          FindNearestTwo(queries, database),
          FindNearestTwoInFloats(queries, database)};
      if (HasByteProducts()) {
        forms.push_back(FindNearestTwoInBytes(queries, database));
      }
      for (const std::vector<NearestTwo>& nearest : forms) {
        ASSERT_EQ(nearest.size(), queries.size());
        for (std::size_t i = 0; i < queries.size(); ++i) {
          const NearestTwo expected = BruteForce(queries[i], database);
          EXPECT_EQ(nearest[i].index, expected.index);
          EXPECT_EQ(nearest[i].distance2, expected.distance2);
          EXPECT_EQ(nearest[i].second_distance2, expected.second_distance2);
        }
      }
    }
  }
}

TEST(FindNearestTwoTest, TheLargestDistanceIsExact) {
  PointDescriptor black, white;
  black.fill(0);
  white.fill(255);
  const auto nearest = FindNearestTwo({black, white}, {white, white});
  EXPECT_EQ(nearest[0].index, 0);
  EXPECT_EQ(nearest[0].distance2, 128 * 255 * 255);
  EXPECT_EQ(nearest[0].second_distance2, 128 * 255 * 255);
  EXPECT_EQ(nearest[1].distance2, 0);
}

TEST(FindNearestTwoApproximatelyTest,
     FindsNearlyAllAndNeverADistanceThatIsNone) {
  // Descriptors as of the same blobs seen again, among strangers.
  const auto database = RandomDescriptors(5, 4000, 256);
  std::vector<PointDescriptor> queries(database.begin(),
                                       database.begin() + 500);
  Random random(6);
  for (PointDescriptor& query : queries) {
    for (std::uint8_t& value : query) {
      value = static_cast<std::uint8_t>(value / 2 + random.Index(128));
    }
  }
  const auto exact = FindNearestTwo(queries, database);
  const auto found = FindNearestTwoApproximately(queries, database);
  const auto again = FindNearestTwoApproximately(queries, database);
  ASSERT_EQ(found.size(), queries.size());
  int num_same = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(found[i].distance2,
              SquaredDistance(queries[i], database[found[i].index]));
    EXPECT_GE(found[i].distance2, exact[i].distance2);
    EXPECT_GE(found[i].second_distance2, exact[i].second_distance2);
    EXPECT_EQ(found[i].index, again[i].index);
    EXPECT_EQ(found[i].second_distance2, again[i].second_distance2);
    num_same += found[i].index == exact[i].index;
  }
  // Descriptors without any structure are the hardest there are for trees.
  EXPECT_GT(num_same, 250);
  EXPECT_EQ(FindNearestTwoApproximately(queries, {}).front().index, -1);
}

// At distance `offset` from `base`, along element `k`.
PointDescriptor Moved(PointDescriptor base, std::size_t k, int offset) {
  base[k] = static_cast<std::uint8_t>(base[k] + offset);
  return base;
}

TEST(MatchPointsTest, TheRatioTestDropsAmbiguousMatches) {
  PointDescriptor base;
  base.fill(100);
  PointMatchOptions options;
  options.max_ratio = 0.8;
  // Distances 79 and 100: kept. 81 and 100: not.
  const std::vector<PointDescriptor> clear = {Moved(base, 0, 79),
                                              Moved(base, 1, 100)};
  const std::vector<PointDescriptor> ambiguous = {Moved(base, 0, 81),
                                                  Moved(base, 1, 100)};
  PointDescriptor far;
  far.fill(0);
  const std::vector<PointDescriptor> first = {base, far};
  EXPECT_THAT(MatchPoints(first, clear, options),
              ElementsAre(FeatureMatch{0, 0}));
  EXPECT_THAT(MatchPoints(first, ambiguous, options), IsEmpty());
}

TEST(MatchPointsTest, TheRatioTestHoldsInBothDirections) {
  PointDescriptor base, far;
  base.fill(100);
  far.fill(0);
  // Seen from the second image, two points of the first look like it.
  const std::vector<PointDescriptor> first = {Moved(base, 0, 10),
                                              Moved(base, 1, 11), far};
  EXPECT_THAT(MatchPoints(first, {base, Moved(far, 0, 3)}, {}),
              ElementsAre(FeatureMatch{2, 1}));
}

TEST(MatchPointsTest, SwappingTheImagesSwapsTheMatches) {
  const auto first = RandomDescriptors(3, 300, 256);
  auto second = RandomDescriptors(4, 250, 256);
  for (std::size_t i = 0; i < 100; ++i) {
    second[2 * i] = Moved(first[3 * i % 300], i, 1);
  }
  const auto forward = MatchPoints(first, second, {});
  auto backward = MatchPoints(second, first, {});
  for (FeatureMatch& match : backward) std::swap(match.first, match.second);
  std::sort(backward.begin(), backward.end());
  EXPECT_EQ(forward, backward);
  EXPECT_GE(forward.size(), 90u);
}

TEST(MatchPointsTest, WithoutASecondNearestThereIsNoMatch) {
  PointDescriptor base;
  base.fill(100);
  EXPECT_THAT(MatchPoints({}, {}, {}), IsEmpty());
  EXPECT_THAT(MatchPoints({base}, {}, {}), IsEmpty());
  EXPECT_THAT(MatchPoints({}, {base}, {}), IsEmpty());
  EXPECT_THAT(MatchPoints({base}, {base}, {}), IsEmpty());
}

TEST(MatchPointsTest, AMovedTurnedAndScaledTextureIsMatched) {
  const BlobTexture texture(21, 500, 260);
  const double angle = 0.5, scale = 1.2;
  Mat2 turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const Vec2 center(125, 125);
  // Where a point of the second image lies in the first.
  const auto first_from_second = [&](const Vec2& p) -> Vec2 {
    return center + turn * (p - center) / scale + Vec2(6.3, -4.8);
  };
  const auto first = DetectPoints(Render(250, 250, texture, 2, 1), {});
  const auto second = DetectPoints(
      Render(
          250, 250,
          [&](const Vec2& p) { return texture(first_from_second(p)); }, 2, 2),
      {});
  ASSERT_THAT(first, IsOk());
  ASSERT_THAT(second, IsOk());
  const auto matches = MatchPoints(first->descriptors, second->descriptors, {});
  int right = 0;
  for (const FeatureMatch& match : matches) {
    const Vec2 expected =
        first_from_second(second->keypoints[match.second].position_px);
    right += (first->keypoints[match.first].position_px - expected).norm() < 1;
  }
  EXPECT_GT(matches.size(), 60u);
  EXPECT_GT(right, 0.95 * static_cast<double>(matches.size()));
}

TEST(PointMatchOptionsTest, RejectsRatiosOutsideTheUnitInterval) {
  PointMatchOptions options;
  for (const double ratio : {0.0, -1.0, 1.1, std::nan("")}) {
    options.max_ratio = ratio;
    EXPECT_THAT(options.Validate(),
                IsError(ErrorCode::kInvalidArgument, "max_ratio"));
  }
}

// Two views of one texture, turned and twice as large in the second. Every
// descriptor has a rival in the second view at about 0.85 of its distance,
// except that of the first two; the last match leads to a wrong place.
struct Views {
  DetectedFeatures first, second;
  static constexpr FeatureIndex kCount = 12;
};

void Add(const Vec2& place, double scale_px, double angle_rad,
         const PointDescriptor& descriptor, DetectedFeatures* view) {
  Keypoint keypoint;
  keypoint.position_px = place;
  keypoint.scale_px = scale_px;
  keypoint.angle_rad = angle_rad;
  view->keypoints.push_back(keypoint);
  view->point_descriptors.push_back(descriptor);
}

Views MakeViews() {
  Views views;
  const Mat2 map = 2 * Eigen::Rotation2Dd(0.4).toRotationMatrix();
  Random random(3);
  std::vector<PointDescriptor> rivals;
  for (FeatureIndex i = 0; i < Views::kCount; ++i) {
    PointDescriptor descriptor, near, rival;
    for (std::size_t k = 0; k < descriptor.size(); ++k) {
      descriptor[k] = static_cast<std::uint8_t>(random.Index(200));
      near[k] = static_cast<std::uint8_t>(descriptor[k] + 17);
      rival[k] = static_cast<std::uint8_t>(descriptor[k] + 20);
    }
    const Vec2 place = testing::UniformVec2(random, {0, 0}, {100, 100});
    Vec2 seen = map * place + Vec2(50, 10);
    if (i + 1 == Views::kCount) seen += Vec2(300, -200);
    Add(place, 2, 0.1, descriptor, &views.first);
    Add(seen, 4, 0.5, near, &views.second);
    if (i >= 2) rivals.push_back(rival);
  }
  for (const PointDescriptor& rival : rivals) {
    Add(testing::UniformVec2(random, {400, 400}, {900, 900}), 2, 0, rival,
        &views.second);
  }
  return views;
}

TEST(MatchPointsRelaxedTest, TakesWhatItsSurroundingsConfirm) {
  const Views views = MakeViews();
  const std::vector<FeatureMatch> strict = MatchPoints(
      views.first.point_descriptors, views.second.point_descriptors, {});
  EXPECT_EQ(strict.size(), 2u);
  const std::vector<FeatureMatch> relaxed =
      MatchPointsRelaxed(views.first, views.second, strict, {});
  EXPECT_EQ(relaxed.size(), Views::kCount - 1u);
  EXPECT_THAT(strict, IsSubsetOf(relaxed));
  for (FeatureIndex i = 0; i + 1 < Views::kCount; ++i) {
    EXPECT_THAT(relaxed, Contains(FeatureMatch{i, i}));
  }
  // No surroundings, no confirmation.
  Views scattered = views;
  Random random(9);
  for (Keypoint& keypoint : scattered.second.keypoints) {
    keypoint.position_px = testing::UniformVec2(random, {0, 0}, {3000, 3000});
  }
  EXPECT_LT(
      MatchPointsRelaxed(scattered.first, scattered.second, strict, {}).size(),
      5u);
}

TEST(MatchPointsRelaxedTest, KeepsTheGivenMatchesAndEveryFeatureOnce) {
  const Views views = MakeViews();
  // A given match that contradicts the candidates wins.
  const std::vector<FeatureMatch> given = {{3, 4}};
  const std::vector<FeatureMatch> relaxed =
      MatchPointsRelaxed(views.first, views.second, given, {});
  EXPECT_THAT(relaxed, Contains(FeatureMatch{3, 4}));
  EXPECT_THAT(relaxed, Not(Contains(FeatureMatch{3, 3})));
  EXPECT_THAT(relaxed, Not(Contains(FeatureMatch{4, 4})));
  EXPECT_TRUE(MatchPointsRelaxed({}, {}, {}, {}).empty());
}

TEST(MatchFeaturesTest, OnlyStarvedPairsAreMatchedAgain) {
  const Views views = MakeViews();
  const std::map<ViewId, DetectedFeatures> features = {{0, views.first},
                                                       {1, views.second}};
  MatchOptions options;
  options.match_lines = false;
  auto matches = MatchFeatures(features, {{0, 1}}, options, RunContext());
  ASSERT_THAT(matches, IsOk());
  EXPECT_EQ(matches->begin()->second.points.size(), Views::kCount - 1u);
  options.relaxed_points.starved_below = 2;  // not fewer
  matches = MatchFeatures(features, {{0, 1}}, options, RunContext());
  ASSERT_THAT(matches, IsOk());
  EXPECT_EQ(matches->begin()->second.points.size(), 2u);
}

TEST(RelaxedPointOptionsTest, RejectsValuesOutOfRange) {
  ExpectRefused(&RelaxedPointOptions::neighbors, 1, "neighbors");
  ExpectRefused(&RelaxedPointOptions::max_deviation, 1, "max_deviation");
  ExpectRefused(&RelaxedPointOptions::max_ratio, 0, "max_ratio");
}

}  // namespace
}  // namespace lowlap
