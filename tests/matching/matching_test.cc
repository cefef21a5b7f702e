#include "lowlap/matching/internal/matching.h"

#include <gmock/gmock.h>

#include "support/matchers.h"
#include "support/synthetic_image.h"

namespace lowlap {
namespace {

using testing::BlobTexture;
using testing::IsError;
using testing::IsOk;
using testing::Render;

std::map<ViewId, DetectedFeatures> ShiftedViews() {
  const BlobTexture texture(31, 300, 220);
  std::map<ViewId, DetectedFeatures> features;
  for (std::uint32_t id = 0; id < 3; ++id) {
    const Vec2 shift(7.0 * id, 3.0 * id);
    features[id] = *DetectFeatures(
        Render(
            180, 160, [&](const Vec2& p) { return texture(p + shift); }, 1, id),
        {});
  }
  return features;
}

TEST(MatchFeaturesTest, TheSameForOneAndTwoThreads) {
  const auto features = ShiftedViews();
  const std::vector<ViewPair> pairs = {{0, 1}, {0, 2}, {1, 2}};
  RunContext context;
  context.num_threads = 1;
  const auto one = MatchFeatures(features, pairs, {}, context);
  context.num_threads = 2;
  const auto two = MatchFeatures(features, pairs, {}, context);
  ASSERT_THAT(one, IsOk());
  ASSERT_THAT(two, IsOk());
  ASSERT_EQ(one->size(), 3u);
  for (const auto& [pair, matches] : *one) {
    EXPECT_GT(matches.points.size(), 40u);
    EXPECT_EQ(matches.points, two->at(pair).points);
    EXPECT_EQ(matches.lines, two->at(pair).lines);
  }
}

TEST(MatchFeaturesTest, KindsCanBeLeftOut) {
  const auto features = ShiftedViews();
  MatchOptions options;
  options.match_points = false;
  const auto matches = MatchFeatures(features, {{0, 1}}, options, {});
  ASSERT_THAT(matches, IsOk());
  EXPECT_TRUE(matches->at({0, 1}).points.empty());
}

TEST(MatchFeaturesTest, ViewsWithoutFeaturesMatchNothing) {
  const auto matches = MatchFeatures({{0, {}}, {1, {}}}, {{0, 1}}, {}, {});
  ASSERT_THAT(matches, IsOk());
  EXPECT_TRUE(matches->at({0, 1}).points.empty());
  EXPECT_TRUE(matches->at({0, 1}).lines.empty());
}

TEST(MatchFeaturesTest, NamesAViewThatWasNotDetected) {
  EXPECT_THAT(MatchFeatures({{0, {}}}, {{0, 4}}, {}, {}),
              IsError(ErrorCode::kInvalidArgument, "view 4"));
}

TEST(MatchFeaturesTest, RejectsBadOptions) {
  MatchOptions options;
  options.lines.max_candidates = -1;
  EXPECT_THAT(MatchFeatures({}, {}, options, {}),
              IsError(ErrorCode::kInvalidArgument, "max_candidates"));
}

}  // namespace
}  // namespace lowlap
