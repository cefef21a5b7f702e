#include "lowlap/adjustment/internal/planes/scene_reach.h"

#include <algorithm>
#include <cstdint>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxCenters = 400;

}  // namespace

SceneReach::SceneReach(const std::vector<FreeLandmark>& landmarks) {
  const std::size_t count = std::min(landmarks.size(), kMaxCenters);
  centers_.resize(static_cast<Eigen::Index>(count), 3);
  Random random(0);
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t drawn =
        count < landmarks.size()
            ? random.Index(static_cast<std::uint32_t>(landmarks.size()))
            : n;
    centers_.row(static_cast<Eigen::Index>(n)) = landmarks[drawn].Center();
  }
}

double SceneReach::Along(const Vec3& direction) const {
  if (centers_.rows() == 0) return 0;
  Eigen::VectorXd along = centers_ * direction;
  double* const begin = along.data();
  double* const end = begin + along.size();
  const Eigen::Index tail = along.size() / 20;
  std::nth_element(begin, begin + tail, end);
  const double low = begin[tail];
  double* const high = end - 1 - tail;
  std::nth_element(begin + tail, high, end);  // what is before is no greater
  return (*high - low) / 0.9;
}

}  // namespace lowlap
