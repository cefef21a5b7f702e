#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/core/internal/median.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/scale/internal/candidate_limits.h"
#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"
#include "lowlap/scale/internal/uncertainty/ratio_refinement.h"

namespace lowlap {
namespace {

using Indices = std::vector<int>;

// By kind.
std::vector<Indices> FindInliers(const RatioSupport& support,
                                 const InlierThresholds& thresholds,
                                 double log_ratio) {
  std::vector<Indices> inliers(support.num_kinds());
  std::vector<float> errors;
  for (int k = 0; k < support.num_kinds(); ++k) {
    if (!(thresholds[k].threshold > 0)) continue;
    const int count = thresholds[k].num_candidates;
    errors.resize(count);
    support.kind(k).Errors(std::exp(log_ratio), count, errors.data());
    for (int n = 0; n < count; ++n) {
      if (errors[n] < thresholds[k].threshold) inliers[k].push_back(n);
    }
  }
  return inliers;
}

// A cell of the middle view, an eighth of its diagonal wide.
int CellAt(const Vec2& place, const TripletView& triplet) {
  constexpr double kCellsPerDiagonal = 8;
  const double cells_per_unit = triplet.geometry.focal_j_px *
                                kCellsPerDiagonal / triplet.image_diagonal_px;
  // Places far outside the image share the cells at the border.
  const auto cell = [&](double coordinate) {
    return static_cast<int>(
        std::lround(std::clamp(coordinate * cells_per_unit, -32.0, 32.0)));
  };
  return 100 * cell(place.x()) + cell(place.y());
}

// The candidates that may agree with a ratio, as measurements of it.
struct Measurements {
  std::vector<RatioFeature> features;
  std::vector<WeightedCandidate> candidates;
  std::vector<RatioGroup> groups;
};

// The noise of the inliers in units of their standard deviations, doubled:
// those within a threshold look too quiet, and an estimate that starts wide
// narrows more surely than a narrow one widens.
double InitialNoise(const std::vector<RatioCandidate>& ratios,
                    const Indices& inliers, double log_ratio) {
  constexpr double kPriorCount = 2.0;
  if (inliers.empty()) return 1.0;
  std::vector<double> deviations;
  for (const int index : inliers) {
    deviations.push_back(std::abs(ratios[index].log_ratio - log_ratio) /
                         ratios[index].log_ratio_stddev);
  }
  const double count = static_cast<double>(inliers.size());
  const double spread = Median(std::move(deviations)) / kMedianOfNorm<1>;
  return 2.0 * std::sqrt((count * spread * spread + kPriorCount) /
                         (count + kPriorCount));
}

Measurements Measure(const TripletView& triplet, const RatioSupport& support,
                     const InlierThresholds& thresholds,
                     const std::vector<Indices>& inliers, double log_ratio) {
  constexpr int kFirstCellAlone = 10000;  // beyond those of the image
  Measurements measurements;
  measurements.groups.resize(support.num_kinds());
  for (int k = 0; k < support.num_kinds(); ++k) {
    if (!(thresholds[k].threshold > 0)) continue;
    const Evidence& kind = support.kind(k);
    RatioGroup& group = measurements.groups[k];
    group.count = thresholds[k].num_candidates;
    group.prior_count = kind.PriorCount();
    group.noise = InitialNoise(kind.ratios(), inliers[k], log_ratio);
    Indices near;
    for (int n = 0; n < group.count; ++n) {
      const RatioCandidate& ratio = kind.ratios()[n];
      group.sum_of_stddevs += ratio.log_ratio_stddev;
      if (std::abs(ratio.log_ratio - log_ratio) <
          kRefinementReach * group.noise * ratio.log_ratio_stddev) {
        near.push_back(n);
      }
    }
    const std::vector<CandidateDetail> details = kind.Details(triplet, near);
    for (std::size_t m = 0; m < near.size(); ++m) {
      RatioFeature feature;
      feature.log_ratio = kind.ratios()[near[m]].log_ratio;
      feature.log_ratio_stddev = kind.ratios()[near[m]].log_ratio_stddev;
      feature.group = k;
      feature.cell = details[m].place
                         ? CellAt(*details[m].place, triplet)
                         : kFirstCellAlone +
                               static_cast<int>(measurements.features.size());
      if (kind.units().num_sides == 2) {
        feature.units = {kind.units().Of(near[m], 0),
                         kind.units().Of(near[m], 1)};
        feature.moves = details[m].moves;
      }
      measurements.features.push_back(feature);
      measurements.candidates.push_back({k, near[m], 0.0});
    }
  }
  return measurements;
}

}  // namespace

ScaleRatio EmptyRatio(const TripletView& triplet,
                      const TripletEvidence& evidence) {
  ScaleRatio ratio;
  ratio.views = triplet.views;
  for (const TripletEvidence::OfKind& of_kind : evidence.kinds) {
    KindSupport& kind = ratio.kinds.emplace_back();
    kind.kind = of_kind.name;
    if (of_kind.evidence == nullptr) continue;
    kind.candidates = of_kind.evidence->size();
    kind.min_agreeing = of_kind.evidence->MinAgreeing();
    ratio.num_rejected_negative += of_kind.evidence->num_rejected_negative();
  }
  return ratio;
}

void RecordNfa(const RatioNfa& nfa, const RatioSupport& support,
               ScaleRatio* ratio) {
  ratio->log10_nfa = nfa.log10_nfa;
  for (int k = 0; k < support.num_kinds(); ++k) {
    ratio->kinds[support.PlaceOf(k)].log10_nfa = nfa.kinds[k].log10_nfa;
  }
}

void RefineOnInliers(const TripletView& triplet, const RatioSupport& support,
                     const InlierThresholds& thresholds, double log_ratio,
                     ScaleRatio* ratio) {
  Measurements measurements =
      Measure(triplet, support, thresholds,
              FindInliers(support, thresholds, log_ratio), log_ratio);
  const RefinedRatio refined =
      RefineRatio(measurements.features, measurements.groups, log_ratio);
  std::vector<WeightedCandidate> candidates;
  for (std::size_t n = 0; n < measurements.candidates.size(); ++n) {
    if (refined.probability[n] < 0.5) continue;
    candidates.push_back(measurements.candidates[n]);
    candidates.back().weight = refined.weight[n];
  }
  const std::vector<Indices> inliers =
      FindInliers(support, thresholds, refined.log_ratio);
  ratio->log_ratio = refined.log_ratio;
  const double stddev =
      std::sqrt(refined.log_ratio_stddev * refined.log_ratio_stddev +
                PoseVariance(triplet, support, candidates));
  ratio->log_ratio_stddev = std::isfinite(stddev) ? stddev : kMaxLogRatioStddev;
  for (int k = 0; k < support.num_kinds(); ++k) {
    KindSupport& kind = ratio->kinds[support.PlaceOf(k)];
    kind.information_share = refined.information_share[k];
    kind.inliers = static_cast<int>(inliers[k].size());
    kind.threshold_px = thresholds[k].threshold;
    support.kind(k).RecordInliers(triplet, inliers[k], ratio);
  }
}

}  // namespace lowlap
