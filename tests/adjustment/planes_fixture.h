#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "lowlap/adjustment/internal/planes/free_landmark.h"
#include "lowlap/core/internal/random.h"
#include "support/random_vectors.h"

namespace lowlap {

/// Landmarks as pairs of poses have them, with errors and known deviations.
class PlaneLandmarks {
 public:
  static constexpr double kStddev = 0.002;

  explicit PlaneLandmarks(std::uint64_t seed) : random_(seed) {}

  /// The poses that see what is added from now on.
  void SeenFrom(std::vector<int> poses) { poses_ = std::move(poses); }

  double Uniform() { return random_.Uniform(-2, 2); }
  Vec3 OnFloor(double height) { return {Uniform(), Uniform(), height}; }
  Vec3 InCloud() { return {Uniform(), Uniform(), Uniform()}; }

  void AddPoint(const Vec3& point) {
    landmarks_.push_back({false, num_points_++, {Place(point)}, poses_});
  }
  void AddLine(const Vec3& from, const Vec3& to) {
    landmarks_.push_back(
        {true, num_lines_++, {Place(from), Place(to)}, poses_});
  }

  const std::vector<FreeLandmark>& landmarks() const { return landmarks_; }

 private:
  FreePlace Place(const Vec3& point) {
    const Vec3 error = testing::GaussianVec3(random_);
    return {point + kStddev * error, kStddev * kStddev * Mat3::Identity()};
  }

  Random random_;
  std::vector<int> poses_ = {0, 1};
  int num_points_ = 0;
  int num_lines_ = 0;
  std::vector<FreeLandmark> landmarks_;
};

}  // namespace lowlap
