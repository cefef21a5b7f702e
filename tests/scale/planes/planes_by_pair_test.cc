#include "lowlap/scale/internal/planes/planes_by_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "scale/row_of_views.h"

namespace lowlap {
namespace {

using testing::RowOfViews;

const ViewTriplet kViews = {0, 1, 2};

// The wall's inverse depth grows with the baseline that is called 1.
TEST(FindPlanesByPair, FindsTheWallOfEveryPairAtItsBaseline) {
  const RowOfViews row;
  const SceneFeatures features(row.scene);
  const auto planes =
      FindPlanesByPair(features, {kViews, {3, 1, 2}}, RunContext());
  ASSERT_TRUE(planes.has_value());
  ASSERT_EQ(planes->size(), 3u);  // of view 1, with 0, 2 and 3
  const auto inverse_depth = [&](ViewId neighbor) {
    const PairPlanes& pair = planes->at({kViews.middle, neighbor});
    EXPECT_FALSE(pair.planes.empty());
    return pair.planes.front().InverseDepth(Vec3(0, 0, 1));
  };
  for (const ViewTriplet& views : {kViews, ViewTriplet{3, 1, 2}}) {
    EXPECT_NEAR(
        std::log(inverse_depth(views.last) / inverse_depth(views.first)),
        row.TrueLogRatio(views), 0.02);
  }
}

TEST(FindPlanesByPair, FindsNoneWithoutAPoseOrFeatures) {
  RowOfViews row;
  row.scene.relative_poses.erase({0, 1});
  row.scene.features.erase(2);
  const SceneFeatures features(row.scene);
  const auto planes = FindPlanesByPair(features, {kViews}, RunContext());
  ASSERT_TRUE(planes.has_value());
  ASSERT_EQ(planes->size(), 2u);
  for (const auto& [views, pair] : *planes) {
    EXPECT_TRUE(pair.planes.empty() && pair.samples.empty());
  }
}

TEST(PairsOverlap, UnlessTheirFeaturesAreApartInTheMiddleView) {
  RowOfViews row;
  EXPECT_TRUE(PairsOverlap(SceneFeatures(row.scene), kViews));
  // The left half for one pair, the right half for the other.
  const auto& points = row.scene.features[kViews.middle].points_px;
  for (const bool left : {true, false}) {
    RelativePose& pose =
        row.scene.relative_poses[left ? ViewPair{0, 1} : ViewPair{1, 2}];
    pose.line_inliers.clear();
    auto& matches = pose.point_inliers;
    matches.erase(std::remove_if(matches.begin(), matches.end(),
                                 [&](const FeatureMatch& match) {
                                   const double x = points[match.first].x();
                                   return (x < 600) != left;
                                 }),
                  matches.end());
    ASSERT_FALSE(matches.empty());
  }
  EXPECT_FALSE(PairsOverlap(SceneFeatures(row.scene), kViews));
}

}  // namespace
}  // namespace lowlap
