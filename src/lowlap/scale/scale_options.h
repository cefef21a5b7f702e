#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap {

/// How the ratio of a triplet is chosen among the candidates.
enum class ScaleCriterion {
  kAContrario,      // lowest number of false alarms; no threshold
  kFixedThreshold,  // most inliers within threshold_px (RANSAC), to compare
};

/// The number of false alarms.
enum class NfaForm {
  kCalibrated,  // keeps the a-contrario promise; the default
  kPaper,       // as printed in Salaün et al. 2017; not calibrated
};

/// Where the ratio with the least NFA is looked for.
enum class RatioSearch {
  kSweep,       // every tau; the default
  kFeatures,    // the ratios of the candidates; of many, a subset first
  kExhaustive,  // the ratio of every candidate (the reference)
};

/// What MakeScaleEstimator makes an estimator from: the command line's choice
/// among the built-in ones.
struct ScaleOptions {
  /// Words for the kinds of evidence that are asked, such as "points"
  /// (EvidenceRegistry::BuiltIn); empty: all.
  std::vector<std::string> features;
  /// Names of kinds that are not, although their word is among them.
  std::vector<std::string> without;

  ScaleCriterion criterion = ScaleCriterion::kAContrario;
  NfaForm nfa_form = NfaForm::kCalibrated;
  /// Inlier threshold of kFixedThreshold.
  double threshold_px = 3.0;
  /// kSweep needs the calibrated a-contrario criterion; the others fall back to
  /// kFeatures.
  RatioSearch search = RatioSearch::kSweep;

  /// Whether a word is among the features.
  bool Asks(const std::string& feature) const;

  Status Validate() const;
};

}  // namespace lowlap
