#pragma once

#include "lowlap/scale/evidence/evidence.h"

namespace lowlap {

/// Evidence whose errors are those of an array of residuals, one for each
/// candidate. Residuals has ErrorOf, Evaluate, Bound and StationaryPoints, as
/// in Evidence. What the refinement asks is answered one by one.
template <class Residuals>
class ResidualEvidence : public Evidence {
 public:
  float ErrorOf(double tau, int candidate) const final {
    return residuals_.ErrorOf(tau, candidate);
  }
  void Errors(double tau, int count, float* errors_px) const final {
    residuals_.Evaluate(tau, count, errors_px);
  }
  void Bound(double tau_low, double tau_high, float* least_px,
             float* most_px) const final {
    residuals_.Bound(tau_low, tau_high, least_px, most_px);
  }
  int StationaryPoints(int candidate, double* taus) const final {
    return residuals_.StationaryPoints(candidate, taus);
  }
  std::vector<CandidateDetail> Details(
      const TripletView& triplet,
      const std::vector<int>& candidates) const final {
    std::vector<CandidateDetail> details;
    details.reserve(candidates.size());
    for (const int n : candidates) details.push_back(DetailOf(triplet, n));
    return details;
  }
  std::vector<RatioCandidate> RatiosIn(
      const TripletView& triplet, const TripletGeometry& geometry,
      const std::vector<int>& candidates) const final {
    std::vector<RatioCandidate> ratios;
    ratios.reserve(candidates.size());
    for (const int n : candidates) {
      ratios.push_back(RatioIn(triplet, geometry, n));
    }
    return ratios;
  }

 protected:
  virtual CandidateDetail DetailOf(const TripletView& triplet,
                                   int candidate) const = 0;
  virtual RatioCandidate RatioIn(const TripletView& triplet,
                                 const TripletGeometry& geometry,
                                 int candidate) const = 0;

  Residuals residuals_;
};

}  // namespace lowlap
