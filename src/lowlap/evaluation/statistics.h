#pragma once

#include <vector>

namespace lowlap {

/// Summary of non-negative errors; all zero for none.
struct ErrorStatistics {
  int count = 0;
  double mean = 0;
  double median = 0;  // mean of the middle two of an even number
  double max = 0;
  double rmse = 0;
};

ErrorStatistics Summarize(std::vector<double> errors);

}  // namespace lowlap
