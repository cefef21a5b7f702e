#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lowlap {

/// The middle element of the sorted values, the upper one of an even number; 0
/// for none. Linear time.
inline double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle =
      values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace lowlap
