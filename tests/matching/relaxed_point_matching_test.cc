#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "lowlap/core/internal/random.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/matching/internal/points/point_matching.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using testing::ExpectRefused;
using testing::IsOk;
using ::testing::IsSubsetOf;
using ::testing::Not;

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
    const Vec2 place(random.Uniform(0, 100), random.Uniform(0, 100));
    Vec2 seen = map * place + Vec2(50, 10);
    if (i + 1 == Views::kCount) seen += Vec2(300, -200);
    Add(place, 2, 0.1, descriptor, &views.first);
    Add(seen, 4, 0.5, near, &views.second);
    if (i >= 2) rivals.push_back(rival);
  }
  for (const PointDescriptor& rival : rivals) {
    Add(Vec2(random.Uniform(400, 900), random.Uniform(400, 900)), 2, 0, rival,
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
    keypoint.position_px =
        Vec2(random.Uniform(0, 3000), random.Uniform(0, 3000));
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
