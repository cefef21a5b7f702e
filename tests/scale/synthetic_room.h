#pragma once

#include <cmath>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/scene/features.h"
#include "support/random_vectors.h"

namespace lowlap::testing {

inline NormalizedSegment MakeSegment(const Vec3& start, const Vec3& end) {
  NormalizedSegment segment;
  segment.start = start / start.z();
  segment.end = end / end.z();
  segment.normal = segment.start.cross(segment.end).normalized();
  return segment;
}

/// A bland room of 6 x 3 x 6 m around the middle camera, which looks along +z;
/// the others stand 0.4 to 1.2 m beside it. 1200 x 800 pixels, f = 900. Draws
/// what is in it, without noise.
class SyntheticRoom {
 public:
  static constexpr double kFocalPx = 900;
  static constexpr double kWidthPx = 1200;
  static constexpr double kHeightPx = 800;

  struct Segment3 {
    Vec3 start, end;
    int wall = -1;
  };

  explicit SyntheticRoom(Random* random) : random_(*random) {
    i_from_j_ = RandomNeighbor(-1);
    k_from_j_ = RandomNeighbor(1);
  }

  /// In metres.
  const RigidTransform& i_from_j() const { return i_from_j_; }
  const RigidTransform& k_from_j() const { return k_from_j_; }

  static bool IsVisible(const Vec3& point_in_cam) {
    return point_in_cam.z() > 0.2 &&
           std::abs(point_in_cam.x() / point_in_cam.z()) <
               0.5 * kWidthPx / kFocalPx &&
           std::abs(point_in_cam.y() / point_in_cam.z()) <
               0.5 * kHeightPx / kFocalPx;
  }

  /// Seen by all three cameras.
  Vec3 VisiblePoint(const RigidTransform& camn_from_camj, bool on_wall) {
    while (true) {
      int wall = 0;
      const Vec3 x = on_wall ? OnWall(&wall) : InSpace();
      if (InBoth(x, i_from_j_) && InBoth(x, k_from_j_) &&
          IsVisible(camn_from_camj * x)) {
        return x;
      }
    }
  }

  /// x at another depth on its ray in camera j, visible in the neighbour.
  Vec3 OtherDepth(const Vec3& x, const RigidTransform& camn_from_camj) {
    while (true) {
      const Vec3 y = x * (random_.Uniform(1.2, 6) / x.z());
      if (IsVisible(camn_from_camj * y)) return y;
    }
  }

  /// Seen by the middle camera and the neighbour.
  Segment3 RandomSegment(const RigidTransform& camn_from_camj, bool on_wall) {
    while (true) {
      Segment3 segment;
      Vec3 direction = UniformVec3(random_, {-1, -1, -1}, {1, 1, 1});
      segment.start = on_wall ? OnWall(&segment.wall) : InSpace();
      if (on_wall) {
        const int normal_axis =
            segment.wall == 0 ? 2 : (segment.wall <= 2 ? 0 : 1);
        direction(normal_axis) = 0;
      }
      segment.end =
          segment.start + random_.Uniform(0.4, 1.2) * direction.normalized();
      if (InBoth(segment.start, camn_from_camj) &&
          InBoth(segment.end, camn_from_camj)) {
        return segment;
      }
    }
  }

 private:
  RigidTransform RandomNeighbor(int side) {
    Vec3 center = UniformVec3(random_, {0.4, -0.2, -0.4}, {1.2, 0.2, 0.4});
    center.x() *= side;
    Vec3 turn = UniformVec3(random_, {-0.05, -0.1, -0.05}, {0.05, 0.2, 0.05});
    turn.y() *= -side;
    return RigidTransform::FromRotationAndCenter(RotationFromAngleAxis(turn),
                                                 center);
  }

  // A random point of a random wall: back, left, right, floor, ceiling.
  Vec3 OnWall(int* wall) {
    *wall = static_cast<int>(random_.Index(5));
    const double u = random_.Uniform(-1, 1), v = random_.Uniform(-1, 1);
    switch (*wall) {
      case 0:
        return {3 * u, 1.5 * v, 4};
      case 1:
        return {-3, 1.5 * u, 1 + 3 * std::abs(v)};
      case 2:
        return {3, 1.5 * u, 1 + 3 * std::abs(v)};
      case 3:
        return {3 * u, -1.5, 1 + 3 * std::abs(v)};
      default:
        return {3 * u, 1.5, 1 + 3 * std::abs(v)};
    }
  }

  Vec3 InSpace() {
    const double z = random_.Uniform(1.5, 6);
    const double x = random_.Uniform(-0.6, 0.6);
    return {x * z, random_.Uniform(-0.4, 0.4) * z, z};
  }

  bool InBoth(const Vec3& x, const RigidTransform& camn_from_camj) const {
    return IsVisible(x) && IsVisible(camn_from_camj * x);
  }

  Random& random_;
  RigidTransform i_from_j_;
  RigidTransform k_from_j_;
};

}  // namespace lowlap::testing
