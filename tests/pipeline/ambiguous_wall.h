#pragma once

#include <cstdint>
#include <string>

#include "lowlap/scene/scene.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "lowlap/two_view/internal/planes/planar_motion.h"

namespace lowlap::testing {

/// Six views of one wall.
inline SyntheticScene Wall(const std::string& pairs, std::uint64_t seed) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kPlanar;
  options.num_views = 6;
  options.pairs = pairs;
  options.noise_px = 0.5;
  options.rotation_noise_deg = 0.05;
  options.direction_noise_deg = 0.1;
  options.seed = seed;
  return *Simulate(options);
}

/// The other motion of the one wall that explains the pair.
inline AlternativeMotion OtherMotion(const ViewPair& views,
                                     const SyntheticScene& synthetic) {
  const Scene& scene = synthetic.scene;
  const RelativePose& pose = scene.relative_poses.at(views);
  const Pose& first = synthetic.true_poses.at(views.first);
  const Vec4& plane = synthetic.planes.front();
  const Vec3 normal = plane.head<3>();
  // normal . X = 1 in camera 1, in units of the baseline.
  const double distance = -(plane[3] + normal.dot(first.center)) /
                          synthetic.true_baselines.at(views);
  const Vec3 ray = scene.FindIntrinsic(views.first)
                       ->Bearing(scene.features.at(views.first)
                                     .points_px[pose.point_inliers[0].first])
                       .value();
  const auto other = OtherPlanarMotion(pose.Cam2FromCam1(),
                                       first.rotation * normal / distance, ray);
  AlternativeMotion motion;
  motion.rotation = other.value().rotation;
  motion.direction = other.value().translation;
  motion.log10_nfa = pose.log10_nfa;
  motion.covariance = pose.covariance;
  return motion;
}

/// The pair gets the other motion of the one wall for its own, and its own for
/// an alternative.
inline void PutWrongMotionFirst(const ViewPair& views,
                                SyntheticScene* synthetic) {
  const AlternativeMotion other = OtherMotion(views, *synthetic);
  RelativePose& pose = synthetic->scene.relative_poses.at(views);
  pose.alternatives.push_back(
      {pose.rotation, pose.direction, pose.log10_nfa, pose.covariance});
  pose.rotation = other.rotation;
  pose.direction = other.direction;
}

}  // namespace lowlap::testing
