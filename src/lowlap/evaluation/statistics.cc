#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lowlap/evaluation/pose_errors.h"

namespace lowlap {

ErrorStatistics Summarize(std::vector<double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  const std::size_t count = errors.size();
  double sum = 0, sum_of_squares = 0;
  for (const double error : errors) {
    sum += error;
    sum_of_squares += error * error;
  }
  result.count = static_cast<int>(count);
  result.mean = sum / static_cast<double>(count);
  result.rmse = std::sqrt(sum_of_squares / static_cast<double>(count));
  result.median = 0.5 * (errors[(count - 1) / 2] + errors[count / 2]);
  result.max = errors.back();
  return result;
}

}  // namespace lowlap
