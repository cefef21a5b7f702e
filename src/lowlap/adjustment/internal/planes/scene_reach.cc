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
  const auto at = [&](Eigen::Index n) {
    std::nth_element(along.data(), along.data() + n,
                     along.data() + along.size());
    return along[n];
  };
  const Eigen::Index tail = along.size() / 20;
  const double low = at(tail);
  return (at(along.size() - 1 - tail) - low) / 0.9;
}

}  // namespace lowlap
