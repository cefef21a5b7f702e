#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace lowlap {

/// Hands out numbers with their indices, the least first (ties by index), where
/// as a rule few are asked for: batch by batch, those below a quantile of a
/// sample are picked out and sorted. O(n) for a few of n numbers, O(n log n)
/// for all. NaN and -infinity are passed over.
class LeastFirst {
 public:
  void Reset(const Eigen::ArrayXd& values);
  /// Number and index; null at the end.
  const std::pair<double, int>* Front();
  void Pop() { ++next_; }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr std::size_t kFirstBatch = 32;

  // Of what is left, about `wanted_` are not above it.
  double Quantile();
  void TakeBatch();

  Eigen::ArrayXd values_;
  std::vector<double> sample_;
  std::vector<std::pair<double, int>> batch_;
  std::size_t next_ = 0;
  std::size_t num_taken_ = 0;
  double above_ = kInfinity;  // what is not above it was handed out
  std::size_t wanted_ = kFirstBatch;
};

}  // namespace lowlap
