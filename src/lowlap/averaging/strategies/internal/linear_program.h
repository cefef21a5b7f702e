#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// min c^T x  s.t.  row_lower <= A x <= row_upper,  lower <= x <= upper.
class LinearProgram {
 public:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  struct Term {
    std::size_t variable;
    double factor;
  };
  struct Optimum {
    std::vector<double> values;
    double objective = 0;
    int num_iterations = 0;
  };

  /// Returns the index of the new variable.
  std::size_t AddVariable(double lower, double upper, double cost);
  /// lower <= sum of the terms <= upper; a variable occurs at most once.
  void AddRow(const std::vector<Term>& terms, double lower, double upper);

  std::size_t num_variables() const { return cost_.size(); }
  std::size_t num_rows() const { return row_lower_.size(); }

  /// By the simplex method (COIN-OR Clp), in one thread; the same program gives
  /// the same optimum. kNumerical if it is infeasible, unbounded, or not done
  /// within `max_iterations`; kCancelled.
  Result<Optimum> Minimize(const RunContext& context = {},
                           int max_iterations = 200000) const;

 private:
  struct Entry {
    std::size_t row;
    double factor;
  };
  std::vector<double> lower_, upper_, cost_, row_lower_, row_upper_;
  std::vector<std::vector<Entry>> columns_;
};

}  // namespace lowlap
