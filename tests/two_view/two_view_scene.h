#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "support/random_vectors.h"

namespace lowlap::testing {

/// Two views of random points, with known truth.
struct TwoViewScene {
  RigidTransform cam2_from_cam1;
  NormalizedFeatures features1;
  NormalizedFeatures features2;
  std::vector<FeatureMatch> matches;
  int num_right = 0;  // the first ones

  TwoViewInput Input() const {
    TwoViewInput input;
    input.views = {3, 8};
    input.features1 = &features1;
    input.features2 = &features2;
    input.point_matches = matches;
    input.image_size1_px = input.image_size2_px = Vec2(1600, 1200);
    return input;
  }
  PointPairs Pairs() const {
    PointPairs pairs{features1.points, features2.points, features1.focal_px,
                     features2.focal_px};
    return pairs;
  }
};

struct TwoViewSceneOptions {
  int num_right = 200;
  int num_wrong = 0;
  double noise_px = 0;
  bool planar = false;
  /// Off-plane points among the right ones, if planar.
  int num_off_plane = 0;
  RigidTransform cam2_from_cam1 = {
      RotationFromAngleAxis(Vec3(0.05, 0.35, -0.04)),
      Vec3(-0.9, 0.1, 0.4).normalized()};
  /// Length of the baseline; the points are 4 to 9 away.
  double baseline = 1;
};

/// A motion towards a slanted plane; the other motion of it, too, keeps all of
/// it in front of both cameras.
inline TwoViewSceneOptions AmbiguousPlane() {
  TwoViewSceneOptions options;
  options.planar = true;
  options.noise_px = 0.3;
  options.cam2_from_cam1 = {RotationFromAngleAxis(Vec3(0.1, -0.1, 0)),
                            Vec3(0, 0.3, -1).normalized()};
  return options;
}

/// Of which the errors of many points leave either motion the better fit.
inline TwoViewSceneOptions AmbiguousPlaneOfManyPoints() {
  TwoViewSceneOptions options = AmbiguousPlane();
  options.num_right = 1000;
  options.noise_px = 0.4;
  return options;
}

inline constexpr double kFocalPx = 1300;

/// The plane n . X = 1 of planar scenes, in camera 1.
inline const Vec3 kPlaneNormal = Vec3(0.4, 0.2, 1).normalized() / 6;

/// A point within the image of 1600 x 1200 pixels, normalised.
inline Vec3 RandomImagePoint(Random& random) {
  return {random.Uniform(-800, 800) / kFocalPx,
          random.Uniform(-600, 600) / kFocalPx, 1};
}

inline TwoViewScene MakeTwoViewScene(const TwoViewSceneOptions& options,
                                     std::uint64_t seed) {
  Random random(seed);
  TwoViewScene scene;
  scene.cam2_from_cam1 = options.cam2_from_cam1;
  scene.num_right = options.num_right;
  scene.features1.focal_px = scene.features2.focal_px = kFocalPx;
  const auto noise = [&]() -> Vec3 {
    const Vec2 error = GaussianVec2(random, options.noise_px) / kFocalPx;
    return {error.x(), error.y(), 0};
  };
  const auto inside = [](const Vec3& x) {
    return std::abs(x.x()) * kFocalPx < 800 && std::abs(x.y()) * kFocalPx < 600;
  };
  const auto add = [&](const Vec3& x1, const Vec3& x2) {
    const auto index = static_cast<FeatureIndex>(scene.matches.size());
    scene.features1.points.push_back(x1);
    scene.features2.points.push_back(x2);
    scene.matches.push_back({index, index});
  };
  while (static_cast<int>(scene.matches.size()) < options.num_right) {
    const Vec3 x1 = RandomImagePoint(random);
    const bool on_plane =
        options.planar &&
        static_cast<int>(scene.matches.size()) >= options.num_off_plane;
    const double depth =
        on_plane ? 1 / kPlaneNormal.dot(x1) : random.Uniform(4, 9);
    const Vec3 y = options.cam2_from_cam1.rotation * (depth * x1) +
                   options.baseline * options.cam2_from_cam1.translation;
    if (y.z() < 0.5 || !inside(y / y.z())) continue;
    add(x1 + noise(), y / y.z() + noise());
  }
  for (int n = 0; n < options.num_wrong; ++n) {
    const Vec3 second = RandomImagePoint(random);
    add(RandomImagePoint(random), second);
  }
  return scene;
}

inline double RotationErrorDeg(const Mat3& a, const Mat3& b) {
  return DegFromRad(RotationAngleBetween(a, b));
}
inline double DirectionErrorDeg(const Vec3& a, const Vec3& b) {
  return DegFromRad(AngleBetween(a, b));
}

/// The indices of all pairs.
inline std::vector<int> AllIndices(const PointPairs& pairs) {
  std::vector<int> all(pairs.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace lowlap::testing
