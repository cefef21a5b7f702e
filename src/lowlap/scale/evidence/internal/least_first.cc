#include "lowlap/scale/evidence/internal/least_first.h"

#include <algorithm>

namespace lowlap {

void LeastFirst::Reset(const Eigen::ArrayXd& values) {
  values_ = values;
  batch_.clear();
  next_ = num_taken_ = 0;
  above_ = -kInfinity;
  wanted_ = kFirstBatch;
}

const std::pair<double, int>* LeastFirst::Front() {
  while (next_ == batch_.size()) {
    if (above_ == kInfinity) return nullptr;
    TakeBatch();
  }
  return &batch_[next_];
}

double LeastFirst::Quantile() {
  constexpr Eigen::Index kStride = 8;
  const std::size_t num_left =
      static_cast<std::size_t>(values_.size()) - num_taken_;
  if (num_left <= 2 * wanted_) return kInfinity;
  sample_.clear();
  for (Eigen::Index n = 0; n < values_.size(); n += kStride) {
    if (values_(n) > above_) sample_.push_back(values_(n));
  }
  const std::size_t rank = wanted_ * sample_.size() / num_left;
  if (rank + 1 >= sample_.size()) return kInfinity;
  const auto at = sample_.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(sample_.begin(), at, sample_.end());
  return *at;
}

void LeastFirst::TakeBatch() {
  const double limit = Quantile();
  batch_.clear();
  next_ = 0;
  for (Eigen::Index n = 0; n < values_.size(); ++n) {
    if (values_(n) <= limit && values_(n) > above_) {
      batch_.emplace_back(values_(n), static_cast<int>(n));
    }
  }
  std::sort(batch_.begin(), batch_.end());
  num_taken_ += batch_.size();
  above_ = limit;
  wanted_ *= 2;
}

}  // namespace lowlap
