#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/scale/evidence/evidence_kind.h"

namespace lowlap::testing {

/// Evidence whose law is known: unrelated ratios are even within kRange, and
/// errors are in units of a width of log tau.
class EvenEvidence : public Evidence {
 public:
  static constexpr double kRange = 8;

  EvenEvidence(const std::vector<double>& log_ratios, double width)
      : width_(width) {
    for (const double log_ratio : log_ratios) {
      AddCandidate({CandidateStatus::kValid, log_ratio, width});
    }
  }
  float ErrorOf(double tau, int candidate) const override {
    return static_cast<float>(
        std::abs(std::log(tau) - ratios()[candidate].log_ratio) / width_);
  }
  double NumTests() const override { return size(); }
  std::optional<LadderProbabilities> Background() const override {
    LadderProbabilities log10_alpha;
    for (int step = 0; step < kNumThresholds; ++step) {
      log10_alpha[step] = Log10Alpha(step);
    }
    return log10_alpha;
  }
  double Log10Alpha(int step) const {
    return std::log10(
        std::min(1.0, 2 * width_ * LadderThresholdPx(step) / kRange));
  }

 private:
  double width_;
};

inline std::shared_ptr<const EvenEvidence> Even(
    const std::vector<double>& log_ratios, double width) {
  return std::make_shared<EvenEvidence>(log_ratios, width);
}

inline TripletEvidence EvidenceOf(
    const std::vector<std::shared_ptr<const Evidence>>& kinds) {
  TripletEvidence evidence;
  for (const auto& kind : kinds) evidence.kinds.push_back({"", kind});
  return evidence;
}

/// A triplet that estimators accept, for evidence that does not look at it.
inline TripletView ValidTriplet() {
  TripletView triplet;
  triplet.views = {0, 1, 2};
  triplet.geometry.cami_from_camj.translation = Vec3::UnitX();
  triplet.geometry.camk_from_camj.translation = Vec3::UnitY();
  triplet.geometry.focal_i_px = triplet.geometry.focal_j_px =
      triplet.geometry.focal_k_px = 1000;
  triplet.image_area_px2 = 1e6;
  triplet.image_diagonal_px = 1500;
  return triplet;
}

}  // namespace lowlap::testing
