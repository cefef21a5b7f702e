#include "lowlap/scale/internal/criterion/ratio_support.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace lowlap {

RatioSupport::RatioSupport(const TripletEvidence& evidence) {
  for (std::size_t place = 0; place < evidence.kinds.size(); ++place) {
    const auto& of_kind = evidence.kinds[place].evidence;
    if (of_kind == nullptr || of_kind->size() == 0) continue;
    int index = 0;
    for (const RatioCandidate& ratio : of_kind->ratios()) {
      hypotheses_.push_back(
          {ratio.log_ratio, ratio.log_ratio_stddev, num_kinds(), index++});
    }
    kinds_.push_back(
        {of_kind, static_cast<int>(place), num_tiers_, num_counters_});
    const EvidenceUnits& units = of_kind->units();
    num_tiers_ += units.num_tiers();
    num_counters_ += units.num_tiers() * units.num_sides;
  }
  std::sort(hypotheses_.begin(), hypotheses_.end(),
            [](const Hypothesis& a, const Hypothesis& b) {
              return std::tie(a.log_ratio, a.kind, a.index) <
                     std::tie(b.log_ratio, b.kind, b.index);
            });
}

int RatioSupport::TierOf(int of_kind, int index) const {
  const EvidenceUnits& units = kind(of_kind).units();
  int tier = 0;
  while (index >= units.tiers[tier].num_candidates) ++tier;
  return tier;
}

std::vector<double> RatioSupport::SortedLogRatios(int of_kind,
                                                  int count) const {
  std::vector<double> sorted;
  sorted.reserve(count);
  for (const Hypothesis& hypothesis : hypotheses_) {
    if (hypothesis.kind == of_kind && hypothesis.index < count) {
      sorted.push_back(hypothesis.log_ratio);
    }
  }
  return sorted;
}

void RatioSupport::Bound(double low, double high, KindErrors* least,
                         KindErrors* most) const {
  const double tau_low = std::exp(low), tau_high = std::exp(high);
  for (KindErrors* bounds : {least, most}) {
    if (bounds == nullptr) continue;
    bounds->resize(kinds_.size());
    for (int k = 0; k < num_kinds(); ++k) (*bounds)[k].resize(kind(k).size());
  }
  for (int k = 0; k < num_kinds(); ++k) {
    kind(k).Bound(tau_low, tau_high,
                  least == nullptr ? nullptr : (*least)[k].data(),
                  most == nullptr ? nullptr : (*most)[k].data());
  }
}

const SupportCounts& RatioSupport::Count(double log_ratio,
                                         SupportWorkspace* workspace) const {
  workspace->counts.resize(num_counters_);
  for (int k = 0; k < num_kinds(); ++k) {
    CountKind(k, log_ratio, kind(k).units().num_tiers() - 1, workspace,
              &workspace->counts[FirstCounter(k)]);
  }
  return workspace->counts;
}

const SupportCounts& RatioSupport::Count(const KindErrors& errors,
                                         SupportWorkspace* workspace) const {
  workspace->counts.resize(num_counters_);
  for (int k = 0; k < num_kinds(); ++k) {
    CountErrors(k, errors[k].data(), kind(k).units().num_tiers() - 1, workspace,
                &workspace->counts[FirstCounter(k)]);
  }
  return workspace->counts;
}

void RatioSupport::CountKind(int of_kind, double log_ratio, int last_tier,
                             SupportWorkspace* workspace,
                             LadderCounts* counts) const {
  const int count = kind(of_kind).units().tiers[last_tier].num_candidates;
  workspace->errors.resize(count);
  kind(of_kind).Errors(std::exp(log_ratio), count, workspace->errors.data());
  CountErrors(of_kind, workspace->errors.data(), last_tier, workspace, counts);
}

void RatioSupport::CountErrors(int of_kind, const float* errors, int last_tier,
                               SupportWorkspace* workspace,
                               LadderCounts* counts) const {
  const EvidenceUnits& units = kind(of_kind).units();
  if (units.num_sides == 1) {
    for (int tier = 0; tier <= last_tier; ++tier) {
      counts[tier] = CountOnLadder(errors, units.tiers[tier].num_candidates);
    }
    return;
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const int side : {0, 1}) {
    workspace->least[side].assign(units.tiers[last_tier].num_units[side],
                                  kInfinity);
  }
  float* const least_first = workspace->least[0].data();
  float* const least_last = workspace->least[1].data();
  const int* const first_of = units.of_pair[0].data();
  const int* const last_of = units.of_pair[1].data();
  int pair = 0;
  for (int tier = 0; tier <= last_tier; ++tier) {
    for (; pair < units.tiers[tier].num_candidates; ++pair) {
      float& first = least_first[first_of[pair]];
      float& last = least_last[last_of[pair]];
      first = std::min(first, errors[pair]);
      last = std::min(last, errors[pair]);
    }
    counts[2 * tier] =
        CountOnLadder(least_first, units.tiers[tier].num_units[0]);
    counts[2 * tier + 1] =
        CountOnLadder(least_last, units.tiers[tier].num_units[1]);
  }
}

}  // namespace lowlap
