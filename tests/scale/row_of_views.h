#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/scene.h"

namespace lowlap::testing {

/// Four views in a row before a tilted wall of points and lines, all pairs.
/// The scene is placed in a world that is turned and scaled as told.
struct RowOfViews {
  Scene scene;
  std::map<ViewPair, double> baselines;

  explicit RowOfViews(const Mat3& world_turn = Mat3::Identity(),
                      double world_scale = 1.0) {
    constexpr int kViews = 4, kPoints = 60, kLines = 40;
    Intrinsic intrinsic;
    intrinsic.width_px = 1200;
    intrinsic.height_px = 800;
    intrinsic.fx_px = intrinsic.fy_px = 900;
    intrinsic.principal_point_px = {600, 400};
    scene.intrinsics[0] = intrinsic;
    Random random(5);
    std::vector<RigidTransform> cams;
    for (std::uint32_t view = 0; view < kViews; ++view) {
      scene.views[view].intrinsic_id = 0;
      scene.views[view].pose_id = view;
      const double x = 0.5 * view + 0.1 * view * view;
      cams.push_back(RigidTransform::FromRotationAndCenter(
          RotationFromAngleAxis({0, 0.02 * view, 0.01}) *
              world_turn.transpose(),
          world_scale * (world_turn * Vec3(x, 0.05 * view, 0))));
    }
    const auto on_wall = [&] {
      const double x = random.Uniform(-0.8, 3.2);
      const Vec3 point(x, random.Uniform(-1.3, 1.3), 4 + 0.4 * x);
      return Vec3(world_scale * (world_turn * point));
    };
    const auto project = [&](const RigidTransform& cam, const Vec3& x) {
      const double u = random.Gaussian(0.3);
      return Vec2(intrinsic.Project(cam * x) + Vec2(u, random.Gaussian(0.3)));
    };
    for (int n = 0; n < kPoints; ++n) {
      const Vec3 x = on_wall();
      for (std::uint32_t view = 0; view < kViews; ++view) {
        scene.features[view].points_px.push_back(project(cams[view], x));
      }
    }
    for (int n = 0; n < kLines; ++n) {
      const Vec3 a = on_wall(), b = on_wall();
      for (std::uint32_t view = 0; view < kViews; ++view) {
        const Vec2 start_px = project(cams[view], a);
        scene.features[view].segments.push_back(
            {start_px, project(cams[view], b), 0.3});
      }
    }
    for (std::uint32_t i = 0; i < kViews; ++i) {
      for (std::uint32_t j = i + 1; j < kViews; ++j) {
        const RigidTransform j_from_i = cams[j] * cams[i].Inverse();
        RelativePose pose;
        pose.views = {i, j};
        pose.rotation = j_from_i.rotation;
        pose.direction = j_from_i.translation.normalized();
        baselines[pose.views] = j_from_i.translation.norm();
        for (FeatureIndex n = 0; n < kPoints; ++n) {
          pose.point_inliers.push_back({n, n});
        }
        for (FeatureIndex n = 0; n < kLines; ++n) {
          pose.line_inliers.push_back({n, n});
        }
        scene.relative_poses[pose.views] = pose;
      }
    }
  }

  double TrueLogRatio(const ViewTriplet& views) const {
    const auto baseline = [&](ViewId a, ViewId b) {
      return baselines.at({std::min(a, b), std::max(a, b)});
    };
    return std::log(baseline(views.middle, views.last) /
                    baseline(views.first, views.middle));
  }
};

}  // namespace lowlap::testing
