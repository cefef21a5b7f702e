#include <algorithm>
#include <cmath>

#include "lowlap/robust/internal/nfa.h"
#include "lowlap/scale/evidence/evidence_kind.h"

namespace lowlap {
namespace {

bool SaysSomething(const RatioCandidate& ratio) {
  return ratio.status == CandidateStatus::kValid &&
         std::isfinite(ratio.log_ratio) &&
         std::isfinite(ratio.log_ratio_stddev) && ratio.log_ratio_stddev > 0;
}

}  // namespace

void Evidence::Errors(double tau, int count, float* errors) const {
  for (int n = 0; n < count; ++n) errors[n] = ErrorOf(tau, n);
}

void Evidence::Bound(double tau_low, double tau_high, float* least,
                     float* most) const {
  for (int n = 0; n < size(); ++n) {
    const double own = std::exp(ratios_[n].log_ratio);
    if (least != nullptr) {
      least[n] = ErrorOf(std::clamp(own, tau_low, tau_high), n);
    }
    if (most != nullptr) {
      most[n] = std::max(ErrorOf(tau_low, n), ErrorOf(tau_high, n));
    }
  }
}

int Evidence::StationaryPoints(int, double*) const { return 0; }

double Evidence::NumTests() const {
  return static_cast<double>(kNumThresholds) * size();
}

std::optional<LadderProbabilities> Evidence::Background() const { return {}; }

NfaTerm Evidence::PaperTerm(const LogFactorials&, const LadderCounts*) const {
  return {};
}

std::vector<CandidateDetail> Evidence::Details(
    const TripletView&, const std::vector<int>& candidates) const {
  return std::vector<CandidateDetail>(candidates.size());
}

std::vector<RatioCandidate> Evidence::RatiosIn(
    const TripletView&, const TripletGeometry&,
    const std::vector<int>& candidates) const {
  std::vector<RatioCandidate> same;
  same.reserve(candidates.size());
  for (const int n : candidates) same.push_back(ratios_[n]);
  return same;
}

void Evidence::RecordInliers(const TripletView&, const std::vector<int>&,
                             ScaleRatio*) const {}

bool Evidence::AddCandidate(const RatioCandidate& ratio) {
  num_rejected_negative_ += ratio.status == CandidateStatus::kNegativeDepth;
  if (!SaysSomething(ratio)) return false;
  ratios_.push_back(ratio);
  units_.tiers[0] = {size(), {size(), 0}};
  return true;
}

void Evidence::StartPairs(int num_tiers) {
  units_.num_sides = 2;
  units_.tiers.assign(num_tiers, {});
}

bool Evidence::AddPair(const RatioCandidate& ratio, int tier,
                       const std::array<int, 2>& members) {
  if (!SaysSomething(ratio)) return false;
  ratios_.push_back(ratio);
  EvidenceUnits::Tier sizes = units_.tiers[tier];
  sizes.num_candidates = size();
  for (const int side : {0, 1}) {
    std::vector<int>& unit_of = unit_of_member_[side];
    const std::size_t member = static_cast<std::size_t>(members[side]);
    if (member >= unit_of.size()) unit_of.resize(member + 1, -1);
    if (unit_of[member] < 0) unit_of[member] = sizes.num_units[side]++;
    units_.of_pair[side].push_back(unit_of[member]);
  }
  std::fill(units_.tiers.begin() + tier, units_.tiers.end(), sizes);
  return true;
}

bool EvidenceKind::MaySpeak(const SceneFeatures&, const ViewTriplet&) const {
  return true;
}

Result<std::shared_ptr<const EvidenceKind>> EvidenceKind::Prepare(
    const SceneFeatures&, const std::vector<ViewTriplet>&,
    const RunContext&) const {
  return std::shared_ptr<const EvidenceKind>();
}

TripletEvidence GatherEvidence(const EvidenceKinds& kinds,
                               const TripletView& triplet) {
  TripletEvidence evidence;
  for (const auto& kind : kinds) {
    evidence.kinds.push_back({kind->Name(), kind->Gather(triplet)});
  }
  return evidence;
}

}  // namespace lowlap
