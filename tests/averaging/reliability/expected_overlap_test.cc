#include "lowlap/averaging/reliability/internal/expected_overlap.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "averaging/reliability/cameras_in_a_row.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// A wall z = 10 of 20 x 20 points, 12 wide and high, that view 0 at the origin
// and view 1, `offset` to the right of it, look at; each observes what
// `observes` says of its columns 0 to 19.
template <class Observes>
Scene SceneOfWall(double offset, const Observes& observes) {
  Scene scene = CamerasInARow(2, offset);
  for (std::uint32_t n = 0; n < 400; ++n) {
    Landmark& landmark = scene.structure[n];
    landmark.position =
        Vec3(n % 20, n / 20, 0) * (12.0 / 20) + Vec3(-5.9, -5.9, 10);
    for (const std::uint32_t view : {0u, 1u}) {
      if (observes(view, n % 20))
        landmark.observations.push_back({view, n, Vec2::Zero()});
    }
  }
  return scene;
}

bool SeesAll(std::uint32_t, std::uint32_t) { return true; }

ExpectedOverlap OverlapOf(const Scene& scene) {
  return OverlapPredictor(scene).Between(0, 1).value();
}

TEST(ExpectedOverlap, IsWhatLiesInTheOtherImage) {
  const ExpectedOverlap same = OverlapOf(SceneOfWall(0, SeesAll));
  EXPECT_EQ(same.share, 1);
  EXPECT_EQ(same.found, 1);
  // The left quarter of the wall is not in the image of view 1.
  const ExpectedOverlap shifted =
      OverlapOf(SceneOfWall(3, [](std::uint32_t view, std::uint32_t column) {
        return view == 0 || column >= 5;
      }));
  EXPECT_NEAR(shifted.share, 0.75, 0.02);
  EXPECT_EQ(shifted.found, 1);
}

TEST(ExpectedOverlap, WhatIsNotFoundIsNoLessExpected) {
  const ExpectedOverlap overlap =
      OverlapOf(SceneOfWall(0, [](std::uint32_t view, std::uint32_t column) {
        return view == column % 2;
      }));
  EXPECT_EQ(overlap.share, 1);
  EXPECT_EQ(overlap.found, 0);
}

TEST(ExpectedOverlap, NothingBehindACameraOrFromTheSideOrFarAway) {
  Scene scene = SceneOfWall(0, SeesAll);
  scene.poses[1].rotation = RotationFromAngleAxis(Vec3(0, RadFromDeg(180), 0));
  EXPECT_EQ(OverlapPredictor(scene).Between(0, 1), std::nullopt);
  // From the other side of the wall, all in its image.
  scene.poses[1].center = Vec3(0, 0, 20);
  EXPECT_EQ(OverlapOf(scene).share, 0);
  // Three times as far.
  scene = SceneOfWall(0, SeesAll);
  scene.poses[1].center = Vec3(0, 0, -20);
  EXPECT_EQ(OverlapOf(scene).share, 0);
  scene.poses[1].center = Vec3(0, 0, -5);
  EXPECT_EQ(OverlapOf(scene).share, 1);
}

// As through a bare wall: what view 1 sees is further away, or elsewhere.
TEST(ExpectedOverlap, NothingWhereTheOtherSeesNothingOfItsOwn) {
  Scene scene = SceneOfWall(
      0, [](std::uint32_t view, std::uint32_t) { return view == 0; });
  for (std::uint32_t n = 0; n < 400; ++n) {
    Landmark& landmark = scene.structure[400 + n];
    landmark.position = scene.structure.at(n).position * 3;
    landmark.observations.push_back({1, n, Vec2::Zero()});
  }
  EXPECT_EQ(OverlapOf(scene).share, 0);
  // View 1 observes the left quarter of the wall only, and nothing beside it.
  scene = SceneOfWall(0, [](std::uint32_t view, std::uint32_t column) {
    return view == 0 || column < 5;
  });
  const double share = OverlapOf(scene).share;
  EXPECT_GE(share, 0.25);
  EXPECT_LE(share, 0.45);
}

TEST(ExpectedOverlap, NothingThatIsHidden) {
  // View 1 observes a wall at a third of the distance, view 0 that behind it.
  Scene scene = SceneOfWall(
      0, [](std::uint32_t view, std::uint32_t) { return view == 0; });
  for (std::uint32_t n = 0; n < 400; ++n) {
    Landmark& landmark = scene.structure[400 + n];
    landmark.position = scene.structure.at(n).position / 3;
    landmark.observations.push_back({1, n, Vec2::Zero()});
  }
  EXPECT_EQ(OverlapOf(scene).share, 0);
  // No wall can be this thin: both see the same place.
  for (std::uint32_t n = 0; n < 400; ++n) {
    scene.structure.at(400 + n).position *= 3 * 0.9;
  }
  EXPECT_EQ(OverlapOf(scene).share, 1);
}

// Of view 1 what is before the right part of the wall, `nearer` times as near,
// is all that it sees there.
Scene SceneOfACorner(double nearer) {
  Scene scene = SceneOfWall(0, [](std::uint32_t view, std::uint32_t column) {
    return view == 0 || column < 8;
  });
  for (std::uint32_t n = 0; n < 400; ++n) {
    if (n % 20 < 8) continue;
    Landmark& landmark = scene.structure[400 + n];
    landmark.position = scene.structure.at(n).position / nearer;
    landmark.observations.push_back({1, n, Vec2::Zero()});
  }
  return scene;
}

TEST(ExpectedOverlap, WhatLiesBehindACornerLeavesNoRegionBare) {
  const Scene corner = SceneOfACorner(1.5);
  EXPECT_GE(OverlapOf(corner).share, 0.9);
  OverlapRegions regions = OverlapPredictor(corner).RegionsOf(0, 1, 0.1);
  EXPECT_GE(regions.num, 5);
  EXPECT_LE(regions.num_bare, 0.1 * regions.num);
  const Scene other_wall = SceneOfACorner(1.1);
  EXPECT_GE(OverlapOf(other_wall).share, 0.9);
  regions = OverlapPredictor(other_wall).RegionsOf(0, 1, 0.1);
  EXPECT_GE(regions.num_bare, 0.4 * regions.num);
}

TEST(ExpectedOverlap, OfAViewWithFewPointsIsNotKnown) {
  const auto with_columns = [](std::uint32_t count) {
    return SceneOfWall(0, [=](std::uint32_t view, std::uint32_t column) {
      return view == 0 || column < count;
    });
  };
  EXPECT_TRUE(OverlapPredictor(with_columns(1)).Between(0, 1));
  EXPECT_FALSE(OverlapPredictor(with_columns(0)).Between(0, 1));
  EXPECT_FALSE(OverlapPredictor(with_columns(1)).Between(0, 2));
  EXPECT_EQ(OverlapPredictor(with_columns(0)).RegionsOf(0, 1, 0.1).num, 0);
  Scene scene = with_columns(20);
  scene.poses.erase(1);
  EXPECT_FALSE(OverlapPredictor(scene).Between(0, 1));
}

// Its polynomial leads points far outside back into the image.
TEST(ExpectedOverlap, ADistortionIsFollowedWhereItIsOne) {
  Scene scene = SceneOfWall(0, SeesAll);
  Intrinsic& intrinsic = scene.intrinsics[0];
  intrinsic.model = CameraModel::kRadialK1;
  intrinsic.distortion = {-0.3};
  EXPECT_EQ(OverlapOf(scene).share, 1);
  // View 1 looks past the wall.
  scene.poses[1].rotation = RotationFromAngleAxis(Vec3(0, RadFromDeg(75), 0));
  const Vec3 point_in_cam =
      scene.poses[1].rotation * scene.structure.at(10 * 20 + 5).position;
  ASSERT_GT(point_in_cam.z(), 0);
  const Vec2 folded = intrinsic.Project(point_in_cam);
  ASSERT_GT(folded.x(), 0);
  ASSERT_LT(folded.x(), 1200);
  EXPECT_FALSE(OverlapPredictor(scene).Between(0, 1));
}

}  // namespace
}  // namespace lowlap
