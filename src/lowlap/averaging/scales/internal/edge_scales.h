#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"

namespace lowlap {

struct EdgeScales {
  /// log length of every edge; 0 for the first edge of a component.
  std::vector<double> log_length;
  /// Edges that ratios join, directly or in steps, have the same label; an
  /// edge without a ratio is alone.
  std::vector<std::size_t> component;
  /// Per ratio: (s_target - s_reference - log_ratio) / stddev.
  std::vector<double> normalised_residuals;
  int num_iterations = 0;
};

/// Edge lengths from ratios: one unknown s_e = log length per edge, one
/// equation s_target - s_reference = log tau per ratio, weighted by 1/sigma^2,
///   min sum rho( (s_target - s_reference - log tau) / sigma ).
/// Iteratively reweighted least squares with the Geman-McClure weight, from two
/// starts: the spanning forest of the most meaningful ratios (least log10 NFA),
/// which a single false ratio spoils, and from there the minimum of the sum of
/// absolute residuals (convex; right up to a third of false ratios and more
/// where every edge has several). The result of least
///   sum (1 + log(1 - log10 NFA)) log(1 + residual^2)
/// is taken; beyond 10,000 ratios only the second start is tried. On a chain
/// both are the paper's recursion, exactly. Gauge: one edge of every component
/// has length 1. The problem must be valid (ValidateProblem). kNumerical if a
/// factorisation fails; kCancelled.
Result<EdgeScales> AverageEdgeScales(const TranslationProblem& problem,
                                     const RunContext& context = {},
                                     int max_iterations = 30);

/// The lengths along the spanning forest alone, without averaging.
EdgeScales ChainEdgeScales(const TranslationProblem& problem);

}  // namespace lowlap
