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

TEST(SceneReach, IsNotThatOfTheFarthest) {
  for (const double far : {1e6, 1.7e308}) {
    std::vector<FreeLandmark> row = Row();
    row[3].places[0].point.x() = far;   // was at 11
    row[4].places[0].point.x() = -far;  // was at 48
    const SceneReach reach(row);
    EXPECT_DOUBLE_EQ(reach.Along(Vec3::UnitX()), (95 - 4) / 0.9) << far;
  }
}

TEST(SceneReach, OneLandmarkReachesNowhere) {
  const std::vector<FreeLandmark> row = Row();
  EXPECT_EQ(SceneReach({row.front()}).Along(Vec3::UnitX()), 0);
  EXPECT_EQ(SceneReach({}).Along(Vec3::UnitX()), 0);
}

}  // namespace
}  // namespace lowlap
