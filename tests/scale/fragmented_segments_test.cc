#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {
namespace {

// Three views before two walls that carry lines; all lines are in every view.
class FragmentedSegments : public ::testing::TestWithParam<ViewId> {
 protected:
  static constexpr FeatureIndex kLines = 40;

  FragmentedSegments() {
    Intrinsic camera;
    camera.width_px = 1200;
    camera.height_px = 800;
    camera.fx_px = camera.fy_px = 900;
    camera.principal_point_px = {600, 400};
    scene_.intrinsics[0] = camera;
    std::vector<RigidTransform> cams;
    for (std::uint32_t view = 0; view < 3; ++view) {
      scene_.views[view].intrinsic_id = 0;
      cams.push_back(RigidTransform::FromRotationAndCenter(
          RotationFromAngleAxis({0.01, 0.03 * view, 0}),
          {0.5 * view + 0.15 * view * view, 0.05 * view, 0}));
    }
    Random random(3);
    const auto on_wall = [&] {
      const double x = random.Uniform(-0.8, 2);
      const double y = random.Uniform(-1.2, 1.2);
      return Vec3(x, y, x < 0.6 ? 4 + 0.5 * x : 4.6 - 0.5 * x);
    };
    for (FeatureIndex n = 0; n < kLines; ++n) {
      const Vec3 a = on_wall(), b = on_wall();
      for (std::uint32_t view = 0; view < 3; ++view) {
        const auto seen = [&](const Vec3& x) -> Vec2 {
          const double u = random.Gaussian(0.2), v = random.Gaussian(0.2);
          return camera.Project(cams[view] * x) + Vec2(u, v);
        };
        const Vec2 start_px = seen(a);
        scene_.features[view].segments.push_back({start_px, seen(b), 0.2});
      }
    }
    for (std::uint32_t view = 0; view < 2; ++view) {
      const RigidTransform next_from_view =
          cams[view + 1] * cams[view].Inverse();
      RelativePose pose;
      pose.views = {view, view + 1};
      pose.rotation = next_from_view.rotation;
      pose.direction = next_from_view.translation.normalized();
      for (FeatureIndex n = 0; n < kLines; ++n) {
        pose.line_inliers.push_back({n, n});
      }
      scene_.relative_poses[pose.views] = pose;
    }
    for (FeatureIndex n = 0; n < kLines; ++n) {
      scene_.line_tracks[n] = {{0, n}, {1, n}, {2, n}};
    }
  }

  // Cuts every segment of a view in two, with a gap of a tenth; matches of one
  // become matches of both, and both are on the track.
  Scene Fragmented(ViewId view) const {
    Scene scene = scene_;
    std::vector<LineSegment>& segments = scene.features[view].segments;
    for (FeatureIndex n = 0; n < kLines; ++n) {
      LineSegment second = segments[n];
      const Vec2 run = second.end_px - second.start_px;
      second.start_px += 0.55 * run;
      segments[n].end_px -= 0.55 * run;
      segments.push_back(second);
    }
    for (auto& [views, pose] : scene.relative_poses) {
      for (FeatureIndex n = 0; n < kLines; ++n) {
        if (views.first == view) pose.line_inliers.push_back({n + kLines, n});
        if (views.second == view) pose.line_inliers.push_back({n, n + kLines});
      }
      std::sort(pose.line_inliers.begin(), pose.line_inliers.end());
    }
    for (auto& [id, track] : scene.line_tracks) {
      track.push_back({view, id.value() + kLines});
      std::sort(track.begin(), track.end());
    }
    return scene;
  }

  static ScaleRatio Ratio(const Scene& scene, const ScaleOptions& options) {
    const auto ratios = EstimateScaleRatios(scene, options, {});
    EXPECT_TRUE(ratios.has_value()) << ratios.error().ToString();
    EXPECT_EQ(ratios->size(), 1u);
    return ratios->front();
  }

  Scene scene_;
};

TEST_P(FragmentedSegments, AreOneLineEach) {
  const Scene fragmented = Fragmented(GetParam());
  const auto triplet = MakeTripletView(SceneFeatures(fragmented), {0, 1, 2});
  ASSERT_TRUE(triplet.has_value());
  EXPECT_EQ(triplet->lines.size(), kLines);
  EXPECT_EQ(triplet->lines_ij.size(), kLines);
  EXPECT_EQ(triplet->lines_jk.size(), kLines);
}

TEST_P(FragmentedSegments, SayNoMoreThanTheWholeOnes) {
  for (const bool coplanar : {false, true}) {
    ScaleOptions options;
    const std::string word = coplanar ? "coplanar" : "lines";
    options.features = {word};
    const ScaleRatio whole = Ratio(scene_, options);
    const ScaleRatio fragmented = Ratio(Fragmented(GetParam()), options);
    EXPECT_EQ(whole.verdict, RatioVerdict::kMeaningful);
    EXPECT_EQ(fragmented.verdict, RatioVerdict::kMeaningful);
    EXPECT_NEAR(fragmented.log_ratio, whole.log_ratio,
                3 * fragmented.log_ratio_stddev);
    // Counted twice they would say almost twice as much.
    EXPECT_GE(fragmented.log10_nfa, 1.2 * whole.log10_nfa);
    if (coplanar) continue;
    EXPECT_LE(fragmented.FindKind(word)->candidates,
              whole.FindKind(word)->candidates);
    EXPECT_LE(fragmented.FindKind(word)->inliers, kLines);
  }
}

INSTANTIATE_TEST_SUITE_P(EveryView, FragmentedSegments,
                         ::testing::Values(0u, 1u, 2u));

}  // namespace
}  // namespace lowlap
