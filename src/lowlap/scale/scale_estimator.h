#pragma once

#include <memory>

#include "lowlap/core/result.h"
#include "lowlap/scale/evidence/evidence_kind.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

/// Finds the ratio tau = lambda(j, k) / lambda(i, j) of a triplet from kinds of
/// evidence. Estimators hold no state between calls and may be shared by
/// threads.
class ScaleEstimator {
 public:
  /// The kinds that it asks, in the order of tables.
  explicit ScaleEstimator(EvidenceKinds kinds);
  virtual ~ScaleEstimator() = default;

  const EvidenceKinds& kinds() const { return kinds_; }

  /// Asks all kinds at once about a triplet and judges what they say. A triplet
  /// without support is not an error but a verdict (kNoCandidates,
  /// kNotMeaningful). kInvalidArgument: a transform, focal length or image size
  /// that is not finite or not positive.
  Result<ScaleRatio> Estimate(const TripletView& triplet) const;

  /// The same from given evidence.
  Result<ScaleRatio> Estimate(const TripletView& triplet,
                              const TripletEvidence& evidence) const;

 protected:
  /// The ratio, from input that Estimate has checked.
  virtual Result<ScaleRatio> Judge(const TripletView& triplet,
                                   const TripletEvidence& evidence) const = 0;

 private:
  EvidenceKinds kinds_;
};

/// The ratio of least NFA (Salaün et al. 2017, section 6) over all ratios, or
/// over those that the candidates ask for (RatioSearch), refined on its
/// inliers. Inliers are the candidates of the kinds whose own NFA is below 1,
/// within the threshold at which it is least. Meaningful if log10 NFA < 0; of a
/// ratio that is not, the best guess and what supports it are reported all the
/// same.
class AContrarioScaleEstimator : public ScaleEstimator {
 public:
  explicit AContrarioScaleEstimator(EvidenceKinds kinds,
                                    NfaForm form = NfaForm::kCalibrated,
                                    RatioSearch search = RatioSearch::kSweep);

 protected:
  Result<ScaleRatio> Judge(const TripletView& triplet,
                           const TripletEvidence& evidence) const override;

 private:
  NfaForm form_;
  RatioSearch search_;
};

/// The ratio with the most inliers within a fixed threshold, as in Salaün et
/// al. 2017, section 5 (RANSAC that tries every feature), for comparison: among
/// those that the candidates ask for, the one with the most inliers of all
/// kinds together, and of equals the one with the least error. It is refined on
/// its inliers, as the a-contrario one is.
///
/// RANSAC has no measure of chance. So that its ratios can be ranked and used
/// like the others, the NFA of the winner is that of the given NFA form, and
/// the verdict is kMeaningful as soon as a second candidate agrees.
class FixedThresholdScaleEstimator : public ScaleEstimator {
 public:
  FixedThresholdScaleEstimator(EvidenceKinds kinds, double threshold_px,
                               NfaForm form = NfaForm::kCalibrated,
                               RatioSearch search = RatioSearch::kFeatures);

 protected:
  Result<ScaleRatio> Judge(const TripletView& triplet,
                           const TripletEvidence& evidence) const override;

 private:
  double threshold_px_;
  NfaForm form_;
  RatioSearch search_;
};

/// The estimator that the options name; they must be valid.
std::unique_ptr<ScaleEstimator> MakeScaleEstimator(const ScaleOptions& options);

}  // namespace lowlap
