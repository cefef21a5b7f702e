#include "lowlap/scene/scene.h"

#include <gtest/gtest.h>

#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/validation.h"
#include "scene/example_scenes.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::FullScene;
using testing::IsOk;
using testing::RandomScene;

TEST(View, PathBelowRootJoinsFolderAndName) {
  View view;
  view.filename = "a b.jpg";
  EXPECT_EQ(view.PathBelowRoot(), "a b.jpg");
  for (const char* folder : {"left/near", "left/near/"}) {
    view.local_path = folder;
    EXPECT_EQ(view.PathBelowRoot(), "left/near/a b.jpg");
  }
}

TEST(WithoutViews, NothingExcludedChangesNothing) {
  const Scene scene = FullScene();
  EXPECT_EQ(WithoutViews(scene, {}), scene);
  EXPECT_EQ(WithoutViews(scene, {0, 999}), scene);  // unknown ids
}

TEST(WithoutViews, RemovesWhatRefersToAView) {
  const Scene scene = WithoutViews(FullScene(), {7});
  EXPECT_THAT(ValidateScene(scene), IsOk());
  EXPECT_EQ(scene.views.count(7), 0u);
  EXPECT_EQ(scene.features.count(7), 0u);
  EXPECT_EQ(scene.intrinsics.count(20), 0u);
  EXPECT_EQ(scene.poses.count(102), 0u);
  EXPECT_EQ(scene.relative_poses.size(), 1u);
  EXPECT_EQ(scene.relative_poses.count({1, 4}), 1u);
  EXPECT_TRUE(scene.scale_ratios.empty());
  // The long track shrinks, the line track of views 4 and 7 goes, and with it
  // the line, and its coplanar pair.
  EXPECT_EQ(scene.point_tracks.at(4000000000u), (Track{{1, 2}, {4, 2}}));
  EXPECT_EQ(scene.line_tracks.count(3), 0u);
  EXPECT_EQ(scene.line_structure.count(3), 0u);
  EXPECT_TRUE(scene.coplanar_pairs.empty());
  EXPECT_EQ(scene.structure.at(9).observations.size(), 2u);
}

TEST(WithoutViews, LineSeenTwiceInOneViewIsNoLine) {
  const Scene scene = WithoutViews(FullScene(), {1});
  EXPECT_THAT(ValidateScene(scene), IsOk());
  EXPECT_EQ(scene.line_tracks.count(2), 0u);  // two segments, one view
}

TEST(WithoutViews, UnrelatedPairsGoWithTheirViews) {
  const Scene scene = WithoutViews(FullScene(), {7});
  EXPECT_EQ(scene.unrelated_pairs, (std::vector<ViewPair>{{4, 10}}));
}

TEST(WithoutViews, KeepsSharedIntrinsics) {
  const Scene scene = WithoutViews(RandomScene(3, 5, 100, 20), {0, 2});
  EXPECT_THAT(ValidateScene(scene), IsOk());
  EXPECT_EQ(scene.views.size(), 3u);
  EXPECT_EQ(scene.intrinsics.size(), 1u);
  EXPECT_EQ(scene.poses.size(), 3u);
}

TEST(WithoutViews, AllViewsLeaveAnEmptyScene) {
  Scene scene = WithoutViews(RandomScene(3, 3, 20, 5), {0, 1, 2});
  EXPECT_EQ(scene.root_path, "images");
  scene.root_path.clear();
  EXPECT_EQ(scene, Scene());
}

TEST(Scene, Lookups) {
  const Scene scene = FullScene();
  EXPECT_EQ(scene.FindIntrinsic(1), &scene.intrinsics.at(0));
  EXPECT_EQ(scene.FindIntrinsic(19), nullptr);  // view without intrinsic
  EXPECT_EQ(scene.FindIntrinsic(2), nullptr);   // no such view
  EXPECT_EQ(scene.FindPose(1), &scene.poses.at(100));
  EXPECT_EQ(scene.FindPose(13), nullptr);
  EXPECT_EQ(scene.FindRelativePose(4, 1), &scene.relative_poses.at({1, 4}));
  EXPECT_EQ(scene.FindRelativePose(1, 7), nullptr);
}

TEST(Scene, ImagePathJoinsItsParts) {
  Scene scene;
  scene.root_path = "root";
  scene.views[0].filename = "a.jpg";
  scene.views[1] = scene.views[0];
  scene.views[1].local_path = "sub";
  EXPECT_EQ(scene.ImagePath(0), "root/a.jpg");
  EXPECT_EQ(scene.ImagePath(1), "root/sub/a.jpg");
  scene.root_path.clear();
  EXPECT_EQ(scene.ImagePath(1), "sub/a.jpg");
}

TEST(Scene, NamesViewsSoThatTheyCanBeToldApart) {
  Scene scene;
  scene.views[1].filename = scene.views[2].filename = "0001.jpg";
  scene.views[1].local_path = "left";
  scene.views[2].local_path = scene.views[3].local_path = "right";
  EXPECT_EQ(scene.NameOf(1), "left/0001.jpg");
  EXPECT_EQ(scene.NameOf(2), "right/0001.jpg");
  EXPECT_EQ(scene.NameOf(3), "3");
  EXPECT_EQ(scene.NameOf(4), "4");
}

TEST(Scene, EqualityNoticesEveryMember) {
  const Scene scene = FullScene();
  const auto differs = [&](auto change) {
    Scene other = scene;
    change(other);
    return !(other == scene);
  };
  EXPECT_TRUE(differs([](Scene& s) { s.root_path += "x"; }));
  EXPECT_TRUE(differs([](Scene& s) { s.views[4].center_prior.reset(); }));
  EXPECT_TRUE(differs([](Scene& s) { s.intrinsics[20].fy_px += 1e-12; }));
  EXPECT_TRUE(differs([](Scene& s) { s.poses[100].center.x() += 1; }));
  EXPECT_TRUE(
      differs([](Scene& s) { s.features[1].segments[0].stddev_px = 9; }));
  EXPECT_TRUE(differs([](Scene& s) {
    s.relative_poses[{1, 4}].covariance.reset();
  }));
  EXPECT_TRUE(differs([](Scene& s) { s.unrelated_pairs.pop_back(); }));
  EXPECT_TRUE(differs([](Scene& s) { s.point_tracks.erase(0); }));
  EXPECT_TRUE(differs([](Scene& s) { s.line_tracks.erase(2); }));
  EXPECT_TRUE(differs([](Scene& s) { s.scale_ratios[0].kinds[1].inliers++; }));
  EXPECT_TRUE(
      differs([](Scene& s) { s.structure[0].observations[0].feature++; }));
  EXPECT_TRUE(differs([](Scene& s) { s.line_structure[2].line.moment *= 2; }));
  EXPECT_TRUE(differs([](Scene& s) { s.coplanar_pairs.clear(); }));
  EXPECT_TRUE(differs([](Scene& s) { s.control_points.erase(5); }));
}

TEST(UnitTransform, GoesEitherWay) {
  RelativePose edge;
  edge.views = {2, 5};
  edge.rotation = RotationFromAngleAxis({0.3, -0.5, 0.2});
  edge.direction = Vec3(2, -1, 2) / 3;
  const RigidTransform forward = UnitTransform(edge, 2, 5);
  const RigidTransform backward = UnitTransform(edge, 5, 2);
  const Vec3 x(0.7, 0.1, 4);
  EXPECT_THAT(
      (forward * x),
      testing::VectorNear(Vec3(edge.rotation * x + edge.direction), 1e-14));
  EXPECT_THAT((backward * (forward * x)), testing::VectorNear(x, 1e-14));
  EXPECT_NEAR(backward.translation.norm(), 1, 1e-14);
}

}  // namespace
}  // namespace lowlap
