#pragma once

#include "lowlap/core/result.h"

namespace lowlap {

/// How the ratio of a triplet is chosen among the candidates.
enum class ScaleCriterion {
  kAContrario,      // lowest number of false alarms; no threshold
  kFixedThreshold,  // most inliers within threshold_px (RANSAC), to compare
};

/// The number of false alarms; see ratio_nfa.h.
enum class NfaForm {
  kCalibrated,  // keeps the a-contrario promise; the default
  kPaper,       // as printed in Salaün et al. 2017; not calibrated
};

/// The residual of a coplanar pair; see ratio_residuals.h.
enum class CoplanarResidual {
  kTransfer,  // crossing carried over to the outer views; the default
  kPlane,     // d_co of the paper, in the middle view; blind to frontal planes
};

/// Where the ratio with the least NFA is looked for.
enum class RatioSearch {
  kSweep,       // every tau, see ratio_sweep.h; the default
  kFeatures,    // the ratios of the features; of many, a subset first
  kExhaustive,  // the ratio of every feature (the reference)
};

struct ScaleOptions {
  bool use_points = true;
  bool use_lines = true;
  bool use_coplanar = true;
  /// With use_coplanar: also points and lines of one pair that lie on a plane
  /// of the other (see plane_points.h), for triplets that nothing else decides
  /// (a second test, which costs log10 2).
  bool use_coplanar_points = true;

  ScaleCriterion criterion = ScaleCriterion::kAContrario;
  NfaForm nfa_form = NfaForm::kCalibrated;
  CoplanarResidual coplanar_residual = CoplanarResidual::kTransfer;

  /// Inlier threshold of kFixedThreshold.
  double threshold_px = 3.0;
  /// Nearest lines that each line is paired with.
  int num_neighbors = 10;
  /// kSweep needs the calibrated a-contrario criterion; the others fall back to
  /// kFeatures.
  RatioSearch search = RatioSearch::kSweep;

  Status Validate() const;
};

}  // namespace lowlap
