#pragma once

#include <vector>

#include "lowlap/scale/evidence/internal/coplanar_candidates.h"
#include "lowlap/scale/evidence/internal/trifocal_point.h"
#include "lowlap/scale/triplet_geometry.h"

namespace lowlap {

// The errors of many features at one tau, in pixels. With one unknown every
// projection is v + tau w, so that an error is a quotient of functions linear
// in tau; their coefficients are computed once, in double precision and scaled
// to the feature's own ratio, and evaluated in single precision (which is good
// to 0.01 px) over whole arrays. An error is huge (over 1e6) or not finite
// where the feature would lie behind a camera.
//
// Bounds over an interval [tau_low, tau_high] are such that every error in it
// is between `least_px` and `most_px` (but for rounding); they close as the
// interval shrinks. Exact for points and transferred crossings side by side: a
// side rises to both ends from its only minimum, whose tau is a root of a
// linear equation. For the others numerators and denominators are bounded apart
// (interval arithmetic). Turns are the taus at which a side of one feature has
// a minimum: kMaxTurns at most, in no order, some may be negative or infinite.

/// The most turns that a feature has.
inline constexpr int kMaxTurns = 4;

/// Trifocal points: the distance from the projection into k of the point
/// triangulated in (i, j) to its observation, and likewise from (k, j) into i;
/// the mean of the two (Salaün et al. 2017, section 5).
class PointResiduals {
 public:
  void Reserve(int count);
  /// The point's ratio must be kValid.
  void Add(const TripletGeometry& geometry, const TrifocalPoint& point,
           const TrifocalMidpoints& midpoints, double log_ratio);
  int size() const { return static_cast<int>(column_[0].size()); }
  /// Writes size() errors.
  void Evaluate(double tau, float* errors_px) const;
  /// The same for one feature.
  float ErrorOf(double tau, int index) const;
  /// Either output may be null.
  void Bound(double tau_low, double tau_high, float* least_px,
             float* most_px) const;
  int Turns(int index, double* taus) const;

 private:
  static constexpr int kSide = 7;
  std::vector<float> column_[2 * kSide];
};

/// Trifocal lines: the mean distance of the two end points observed in k to the
/// projection of the infinite line from (i, j), and likewise from (k, j) into
/// i; the mean of the two.
class LineResiduals {
 public:
  void Add(const TripletGeometry& geometry, const TrifocalLine& line,
           double log_ratio);
  int size() const { return static_cast<int>(column_[0].size()); }
  void Evaluate(double tau, float* errors_px) const;
  float ErrorOf(double tau, int index) const;
  void Bound(double tau_low, double tau_high, float* least_px,
             float* most_px) const;
  int Turns(int index, double* taus) const;

 private:
  static constexpr int kSide = 8;
  std::vector<float> column_[2 * kSide];
};

/// Coplanar pairs, transfer residual: the crossing x in view j, put at depth
/// z_a on line a, is projected into k, where its distance to line b is taken;
/// and x at depth z_b on line b into i, against line a; the mean of the two. It
/// reacts evenly at every tilt of the plane.
class TransferResiduals {
 public:
  void Add(const TripletGeometry& geometry, const MatchedLine& a,
           const MatchedLine& b, double log_ratio);
  int size() const { return static_cast<int>(column_[0].size()); }
  /// Writes the errors of the first `count` pairs.
  void Evaluate(double tau, int count, float* errors_px) const;
  float ErrorOf(double tau, int index) const;
  void Bound(double tau_low, double tau_high, int count, float* least_px,
             float* most_px) const;
  int Turns(int index, double* taus) const;

 private:
  static constexpr int kSide = 5;
  std::vector<float> column_[2 * kSide];
};

/// Coplanar pairs, d_co of the paper: the point of line a closest to line b and
/// the point of b closest to a, both projected into view j; their distance.
/// With n = d_a x d_b and D = tau X_b - X_a:
///   P_ab = X_a + det[D, d_b, n]/|n|^2 d_a,
///   P_ba = tau X_b + det[D, d_a, n]/|n|^2 d_b.
/// Zero at every tau if the plane is perpendicular to the viewing ray. A pair
/// that is parallel in space has no closest points and a huge error.
class PlaneResiduals {
 public:
  void Add(const TripletGeometry& geometry, const MatchedLine& a,
           const MatchedLine& b, double log_ratio);
  int size() const { return static_cast<int>(column_[0].size()); }
  /// Writes the errors of the first `count` pairs.
  void Evaluate(double tau, int count, float* errors_px) const;
  float ErrorOf(double tau, int index) const;
  void Bound(double tau_low, double tau_high, int count, float* least_px,
             float* most_px) const;
  int Turns(int index, double* taus) const;

 private:
  static constexpr int kColumns = 12;
  std::vector<float> column_[kColumns];
};

}  // namespace lowlap
