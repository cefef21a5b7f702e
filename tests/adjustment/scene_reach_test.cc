#include "lowlap/adjustment/internal/planes/scene_reach.h"

#include <gtest/gtest.h>

#include <vector>

namespace lowlap {
namespace {

// At 0, 1, ..., 99 along x, in no order.
std::vector<FreeLandmark> Row() {
  std::vector<FreeLandmark> landmarks;
  for (int n = 0; n < 100; ++n) {
    const Vec3 point(37 * n % 100, 5, 0);
    landmarks.push_back({false, n, {{point, Mat3::Zero()}}, {0, 1}});
  }
  return landmarks;
}

TEST(SceneReach, IsTheMiddleNineTenthsMadeUpToAll) {
  const SceneReach reach(Row());
  EXPECT_DOUBLE_EQ(reach.Along(Vec3::UnitX()), (94 - 5) / 0.9);
  EXPECT_DOUBLE_EQ(reach.Along(-Vec3::UnitX()), (94 - 5) / 0.9);
  EXPECT_EQ(reach.Along(Vec3::UnitY()), 0);
}

TEST(SceneReach, OneLandmarkReachesNowhere) {
  const std::vector<FreeLandmark> row = Row();
  EXPECT_EQ(SceneReach({row.front()}).Along(Vec3::UnitX()), 0);
  EXPECT_EQ(SceneReach({}).Along(Vec3::UnitX()), 0);
}

}  // namespace
}  // namespace lowlap
