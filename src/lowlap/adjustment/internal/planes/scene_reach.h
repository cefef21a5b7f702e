#pragma once

#include <Eigen/Core>
#include <vector>

#include "lowlap/adjustment/internal/planes/free_landmark.h"

namespace lowlap {

/// How far the landmarks of a scene reach along a direction.
class SceneReach {
 public:
  explicit SceneReach(const std::vector<FreeLandmark>& landmarks);

  /// The middle nine tenths of the centres, made up to all; of four hundred
  /// landmarks at most, drawn.
  double Along(const Vec3& direction) const;

 private:
  Eigen::Matrix<double, Eigen::Dynamic, 3> centers_;
};

}  // namespace lowlap
