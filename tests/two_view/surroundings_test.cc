#include "lowlap/two_view/internal/evidence/surroundings.h"

#include <gtest/gtest.h>

#include <vector>

#include "lowlap/core/internal/random.h"
#include "support/random_vectors.h"
#include "two_view/two_view_scene.h"

namespace lowlap {
namespace {

// Two views of a wall, 4 to 5 away, and of what stands before it.
class WallPair {
 public:
  void Add(const Vec3& point, bool is_matched) {
    const auto index = static_cast<FeatureIndex>(first_.points.size());
    first_.points.push_back(point.hnormalized().homogeneous());
    second_.points.push_back(
        (cam2_from_cam1_ * point).hnormalized().homogeneous());
    if (is_matched) inliers_.push_back({index, index});
  }

  // One point in `every` is matched.
  void AddWall(int num, int every, const Vec3& least, const Vec3& greatest) {
    for (int n = 0; n < num; ++n) {
      Add(testing::UniformVec3(random_, least, greatest),
          every > 0 && n % every == 0);
    }
  }

  double Log10Chance() const {
    return Log10ChanceOfSurroundings(first_, second_, Pose());
  }

  double Log10ChanceOfSwapped() const {
    RelativePose pose = Pose();
    const RigidTransform inverse = pose.Cam2FromCam1().Inverse();
    pose.rotation = inverse.rotation;
    pose.direction = inverse.translation;
    return Log10ChanceOfSurroundings(second_, first_, pose);
  }

  RelativePose Pose() const {
    RelativePose pose;
    pose.views = {0, 1};
    pose.rotation = cam2_from_cam1_.rotation;
    pose.direction = cam2_from_cam1_.translation;
    pose.point_inliers = inliers_;
    return pose;
  }

  const std::vector<Vec3>& FirstPoints() const { return first_.points; }
  void LeaveOutOfSecond(std::size_t from) { second_.points.resize(from); }

 private:
  const RigidTransform cam2_from_cam1_{
      RotationFromAngleAxis({0.02, 0.15, -0.01}),
      Vec3(-0.8, 0.1, 0.1).normalized()};
  Random random_{3};
  NormalizedFeatures first_, second_;
  std::vector<FeatureMatch> inliers_;
};

const Vec3 kLeast(-2.5, -1.8, 4), kGreatest(2.5, 1.8, 5);
const Vec3 kLeastOfThing(-0.5, -0.4, 3.8), kGreatestOfThing(0.5, 0.4, 4);

TEST(Surroundings, MatchWhereBothViewsSeeOnePlace) {
  WallPair pair;
  pair.AddWall(2000, 10, kLeast, kGreatest);
  EXPECT_GT(pair.Log10Chance(), -0.01);
}

TEST(Surroundings, DoNotMatchAroundThingsThatLookAlike) {
  WallPair pair;
  pair.AddWall(2000, 0, kLeast, kGreatest);
  pair.AddWall(300, 4, kLeastOfThing, kGreatestOfThing);
  EXPECT_LT(pair.Log10Chance(), -5);
  EXPECT_NEAR(pair.Log10ChanceOfSwapped(), pair.Log10Chance(), 1e-9);
}

// What the second view sees is the thing alone.
TEST(Surroundings, AreNotAskedForWhereTheOtherViewDoesNotLook) {
  WallPair pair;
  pair.AddWall(300, 4, kLeastOfThing, kGreatestOfThing);
  pair.AddWall(2000, 0, kLeast, kGreatest);
  pair.LeaveOutOfSecond(300);
  EXPECT_GT(pair.Log10Chance(), -0.5);
}

// Where few of the features match, most places have none by chance.
TEST(Surroundings, AreNotAskedForWhereMatchesAreRare) {
  WallPair pair;
  pair.AddWall(300, 30, kLeastOfThing, kGreatestOfThing);
  pair.AddWall(600, 0, kLeast, kGreatest);
  EXPECT_GT(pair.Log10Chance(), -0.1);
}

TEST(Surroundings, SayNothingWithoutInliers) {
  WallPair pair;
  EXPECT_EQ(pair.Log10Chance(), 0);
  pair.AddWall(100, 0, kLeast, kGreatest);
  EXPECT_EQ(pair.Log10Chance(), 0);
}

TEST(Surroundings, SayNothingWhereAllIsOnePlace) {
  WallPair pair;
  for (int n = 0; n < 20; ++n) pair.Add({0, 0, 4}, true);
  EXPECT_EQ(pair.Log10Chance(), 0);
}

}  // namespace
}  // namespace lowlap
