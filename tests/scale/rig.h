#pragma once

#include <cmath>

#include "lowlap/scale/triplet_view.h"
#include "scale/synthetic_room.h"
#include "scale/synthetic_triplet.h"

namespace lowlap::testing {

/// i one unit to the left, k two units to the right and a little ahead; no
/// rotation; the true ratio is |c_k|.
struct Rig {
  Vec3 center_i{-1, 0, 0};
  Vec3 center_k{2, 0.3, 0.5};
  TripletGeometry geometry;

  Rig() {
    geometry.cami_from_camj = {Mat3::Identity(), -center_i};
    geometry.camk_from_camj = {Mat3::Identity(), -center_k.normalized()};
    geometry.focal_i_px = geometry.focal_j_px = geometry.focal_k_px = 1000;
  }
  double LogRatio() const { return std::log(center_k.norm()); }
  TripletPoint Point(const Vec3& x) const {
    const auto ray = [](const Vec3& v) { return Vec3(v / v.z()); };
    return {0, ray(x - center_i), ray(x), ray(x - center_k)};
  }
  ObservedSegment See(const Vec3& center, const Vec3& a, const Vec3& b) const {
    return {MakeSegment(a - center, b - center), 0.5};
  }
  TripletLine Line(const Vec3& a, const Vec3& b) const {
    return {0, See(center_i, a, b), See(Vec3::Zero(), a, b),
            See(center_k, a, b)};
  }
  MatchedLine WithI(const Vec3& a, const Vec3& b) const {
    return {0, See(Vec3::Zero(), a, b), See(center_i, a, b)};
  }
  MatchedLine WithK(const Vec3& a, const Vec3& b) const {
    return {1, See(Vec3::Zero(), a, b), See(center_k, a, b)};
  }
};

/// Thirty of each kind of feature, with a noise of one pixel.
inline SyntheticTriplet NoisyTriplet() {
  SyntheticTripletOptions options;
  options.num_points = options.num_lines = 30;
  options.num_lines_ij = options.num_lines_jk = 30;
  options.noise_px = 1;
  return MakeSyntheticTriplet(options, 11);
}

inline Vec2 Project(const Vec3& x) { return x.head<2>() / x.z(); }

inline double ToLine(const Vec2& p, const Vec3& line) {
  return std::abs(line.dot(p.homogeneous())) / line.head<2>().norm();
}

/// The triplet's transform at the baseline lambda.
inline RigidTransform Scaled(const RigidTransform& unit, double lambda) {
  return {unit.rotation, lambda * unit.translation};
}

}  // namespace lowlap::testing
