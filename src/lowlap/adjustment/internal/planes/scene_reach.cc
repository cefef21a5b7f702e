#include "lowlap/adjustment/internal/planes/scene_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxCenters = 400;

// Values for order statistics: only those of one bin have to be put in order.
class BinnedValues {
 public:
  explicit BinnedValues(Eigen::VectorXd values)
      : values_(std::move(values)),
        bins_(Eigen::ArrayXi::Zero(values_.size())) {
    const double least = values_.minCoeff();
    const double bins_per_unit = (kNumBins - 1) / (values_.maxCoeff() - least);
    // Else they are the same, or too far apart for a difference.
    if (std::isfinite(bins_per_unit) && bins_per_unit > 0) {
      bins_ = ((values_.array() - least) * bins_per_unit).cast<int>();
    }
    for (const int bin : bins_) ++counts_[bin];
  }

  // The value with `rank` smaller ones before it.
  double Ranked(Eigen::Index rank) const {
    int bin = 0;
    for (; rank >= counts_[bin]; ++bin) rank -= counts_[bin];
    std::vector<double> members;
    members.reserve(static_cast<std::size_t>(counts_[bin]));
    for (Eigen::Index n = 0; n < values_.size(); ++n) {
      if (bins_[n] == bin) members.push_back(values_[n]);
    }
    std::nth_element(members.begin(), members.begin() + rank, members.end());
    return members[rank];
  }

 private:
  static constexpr int kNumBins = 64;

  Eigen::VectorXd values_;
  Eigen::ArrayXi bins_;
  std::array<Eigen::Index, kNumBins> counts_{};
};

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
  const BinnedValues along(centers_ * direction);
  const Eigen::Index tail = centers_.rows() / 20;
  return (along.Ranked(centers_.rows() - 1 - tail) - along.Ranked(tail)) / 0.9;
}

}  // namespace lowlap
