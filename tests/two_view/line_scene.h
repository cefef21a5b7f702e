#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/features.h"
#include "support/random_vectors.h"
#include "two_view/two_view_scene.h"

namespace lowlap::testing {

struct LineSceneOptions {
  /// Directions of the families of parallel lines, in camera 1; the angles
  /// between them are not right ones.
  std::array<Vec3, 3> directions = {Vec3(0.1, 1, 0.05).normalized(),
                                    Vec3(1, 0.1, 0.4).normalized(),
                                    Vec3(-0.5, 0.05, 1).normalized()};
  int lines_per_family = 12;
  /// Segments that run anywhere, in both views, unmatched.
  int num_clutter = 0;
  double noise_px = 0;  // of end points
};

/// Lines of three directions on three planes, matched in both views; each plane
/// holds lines of two directions, which cross.
struct LineScene {
  RigidTransform cam2_from_cam1;
  std::array<Vec3, 3> directions;
  TwoViewScene views;  // without points
  std::vector<FeatureMatch> line_matches;

  TwoViewInput Input() const {
    TwoViewInput input = views.Input();
    input.line_matches = line_matches;
    return input;
  }
};

inline NormalizedSegment MakeSegment(const Vec3& start, const Vec3& end) {
  return {start, end, start.cross(end).normalized()};
}

inline LineScene MakeLineScene(const LineSceneOptions& options,
                               std::uint64_t seed) {
  Random random(seed);
  LineScene scene;
  scene.cam2_from_cam1 = TwoViewSceneOptions().cam2_from_cam1;
  scene.directions = options.directions;
  NormalizedFeatures &f1 = scene.views.features1, &f2 = scene.views.features2;
  f1.focal_px = f2.focal_px = kFocalPx;
  const auto image = [&](const Vec3& p) -> Vec3 {
    const Vec2 noise = GaussianVec2(random, options.noise_px) / kFocalPx;
    return p / p.z() + Vec3(noise.x(), noise.y(), 0);
  };
  const auto inside = [](const Vec3& p) {
    return p.z() > 0.5 && std::abs(p.x() / p.z()) * kFocalPx < 800 &&
           std::abs(p.y() / p.z()) * kFocalPx < 600;
  };
  for (int family = 0; family < 3; ++family) {
    for (int count = 0; count < options.lines_per_family;) {
      // Half of a family shares a plane with the next family, the other half
      // with the one before it.
      const int plane = count % 2 == 0 ? family : (family + 2) % 3;
      const Vec3& along = options.directions[family];
      const Vec3& across =
          options.directions[count % 2 == 0 ? (family + 1) % 3 : plane];
      const Vec3 origin(0.3 * plane - 0.3, 0.2 * plane, 5 + 0.8 * plane);
      const double forward = random.Uniform(-1.5, 1.5);
      const Vec3 middle =
          origin + random.Uniform(-2, 2) * across + forward * along;
      const double half = random.Uniform(0.3, 1.2);
      const Vec3 a = middle - half * along, b = middle + half * along;
      const Vec3 a2 = scene.cam2_from_cam1 * a, b2 = scene.cam2_from_cam1 * b;
      if (!inside(a) || !inside(b) || !inside(a2) || !inside(b2)) continue;
      const auto index = static_cast<FeatureIndex>(f1.segments.size());
      const Vec3 end1 = image(b), start1 = image(a);
      const Vec3 end2 = image(b2), start2 = image(a2);
      f1.segments.push_back(MakeSegment(start1, end1));
      f2.segments.push_back(MakeSegment(start2, end2));
      scene.line_matches.push_back({index, index});
      ++count;
    }
  }
  for (int n = 0; n < options.num_clutter; ++n) {
    for (NormalizedFeatures* f : {&f1, &f2}) {
      const Vec3 start = RandomImagePoint(random);
      const double angle = random.Uniform(0, 2 * kPi);
      const double length = random.Uniform(40, 200) / kFocalPx;
      f->segments.push_back(MakeSegment(
          start, start + length * Vec3(std::cos(angle), std::sin(angle), 0)));
    }
  }
  return scene;
}

}  // namespace lowlap::testing
