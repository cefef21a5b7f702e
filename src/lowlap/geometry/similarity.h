#pragma once

#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// x_target = scale rotation x_source + translation.
struct Similarity {
  double scale = 1.0;
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 operator*(const Vec3& x) const {
    return scale * (rotation * x) + translation;
  }
  Similarity Inverse() const;
};

/// The similarity that minimises sum |target_n - S source_n|^2 (Umeyama 1991).
///
/// Needs equally many points on both sides, at least 2, and on either side some
/// that do not coincide. With 2 points, or collinear ones, the rotation about
/// the line is free and the smallest is returned. Errors: kInvalidArgument,
/// kInsufficientData.
Result<Similarity> AlignPoints(const std::vector<Vec3>& source,
                               const std::vector<Vec3>& target);

}  // namespace lowlap
