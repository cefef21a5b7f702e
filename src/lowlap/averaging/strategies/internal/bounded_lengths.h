#pragma once

#include <string>
#include <utility>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct BoundedLengthsOptions {
  /// In lengths of the shortest edge; infinite: least squares.
  double loss_width = 0.01;
  int max_iterations = 300;

  static BoundedLengthsOptions L2Chordal();
  static BoundedLengthsOptions SoftL1();
  static BoundedLengthsOptions Lud();

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("loss_width", &loss_width,
          "where the loss goes from squares to absolute values, in lengths of "
          "the shortest edge");
    visit("max_iterations", &max_iterations, "at most so many iterations");
  }
};

/// Centres from directions with lengths of at least one:
///
///   min over C, s  sum b^2 (sqrt(1 + r_ij^2 / b^2) - 1),
///   r_ij = |C_j - C_i - s_ij d_ij|,   s_ij >= 1.
///
/// Least squares for residuals below the width b, absolute values above. The
/// bound keeps the centres from collapsing; lengths are in units of the
/// shortest edge. Convex, so the start does not matter; iteratively reweighted
/// least squares (MinimiseNarrowing). Three published methods differ in b:
///
/// - l2_chordal, b infinite (Tron & Vidal, "Distributed image-based 3-D
///   localization of camera sensor networks", CDC 2009): not robust, one wrong
///   direction bends everything near it, and long edges weigh more than short
///   ones.
/// - soft_l1, b = 0.01 (Moulon, Monasse, Perrot, Marlet, "OpenMVG: Open
///   multiple view geometry", 2016), on pairwise directions.
/// - lud, b = 1e-6 (Ozyesil & Singer, "Robust camera location estimation by
///   convex programming", CVPR 2015): exact in spite of some wrong directions
///   if the others are exact.
///
/// Unweighted, as published: ratios and deviations are ignored. Only
/// parallel-rigid parts of three or more views are placed
/// (SolveDirectionParts), each in a component of its own.
class BoundedLengthsAverager : public TranslationAverager {
 public:
  BoundedLengthsAverager(std::string name, BoundedLengthsOptions options)
      : name_(std::move(name)), options_(options) {}
  std::string Name() const override { return name_; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;

 private:
  std::string name_;
  BoundedLengthsOptions options_;
};

}  // namespace lowlap
