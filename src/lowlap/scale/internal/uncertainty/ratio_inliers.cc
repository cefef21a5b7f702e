#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/core/median.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"
#include "lowlap/scale/internal/uncertainty/ratio_refinement.h"

namespace lowlap {
namespace {

using Indices = std::vector<int>;

struct Inliers {
  Indices points;
  Indices lines;
  Indices pairs;
  Indices plane_points;
};

// The features of a kind that are considered.
std::size_t NumOf(const RatioSupport& support, FeatureKind kind,
                  const InlierThresholds& thresholds) {
  return kind == FeatureKind::kCoplanar ? thresholds.num_pairs
                                        : support.Ratios(kind).size();
}

Indices Below(const RatioSupport& support, FeatureKind kind, double log_ratio,
              double threshold_px, const InlierThresholds& thresholds) {
  Indices indices;
  if (!(threshold_px > 0)) return indices;
  std::vector<float> errors_px;
  support.Errors(kind, log_ratio, &errors_px);
  for (std::size_t n = 0; n < NumOf(support, kind, thresholds); ++n) {
    if (errors_px[n] < threshold_px) indices.push_back(static_cast<int>(n));
  }
  return indices;
}

Inliers FindInliers(const RatioSupport& support,
                    const InlierThresholds& thresholds, double log_ratio) {
  const auto below = [&](FeatureKind kind, double threshold_px) {
    return Below(support, kind, log_ratio, threshold_px, thresholds);
  };
  return {below(FeatureKind::kPoint, thresholds.points_px),
          below(FeatureKind::kLine, thresholds.lines_px),
          below(FeatureKind::kCoplanar, thresholds.coplanar_px),
          below(FeatureKind::kPlanePoint, thresholds.plane_points_px)};
}

// A cell of the middle view, an eighth of its diagonal wide: of a point, of the
// middle of a segment, of the crossing of a pair.
int CellOf(const RatioSupport& support, const TripletView& triplet,
           FeatureKind kind, int index) {
  constexpr double kCellsPerDiagonal = 8;
  Vec3 at = Vec3::Zero();
  if (kind == FeatureKind::kPoint) {
    at = triplet.points[support.PointOf(index)].in_j;
  } else if (kind == FeatureKind::kLine) {
    const NormalizedSegment& segment =
        triplet.lines[support.LineOf(index)].in_j.segment;
    at = 0.5 * (segment.start + segment.end);
  } else if (kind == FeatureKind::kPlanePoint) {
    at = triplet.plane_points[index].point.in_j;
  } else {
    const CoplanarPairCandidate& pair = support.Pair(index);
    at = CrossingInMiddle(triplet.lines_ij[pair.first].in_middle.segment,
                          triplet.lines_jk[pair.last].in_middle.segment)
             .value_or(at);
  }
  const double cells_per_unit = triplet.geometry.focal_j_px *
                                kCellsPerDiagonal / triplet.image_diagonal_px;
  // Crossings far outside the image share the cells at the border.
  const auto cell = [&](double coordinate) {
    return static_cast<int>(
        std::lround(std::clamp(coordinate * cells_per_unit, -32.0, 32.0)));
  };
  return 100 * cell(at.x()) + cell(at.y());
}

// The features that may agree with a ratio, as measurements of it.
struct Measurements {
  std::vector<RatioFeature> features;
  std::vector<WeightedFeature> of_kind;
  std::vector<RatioGroup> groups;
};

// The noise of the inliers in units of their standard deviations, doubled:
// those within a threshold look too quiet, and an estimate that starts wide
// narrows more surely than a narrow one widens.
double InitialNoise(const std::vector<RatioCandidate>& ratios,
                    const Indices& inliers, double log_ratio) {
  constexpr double kStddevOfMedianDeviation = 1.4826;
  constexpr double kPriorCount = 2.0;
  if (inliers.empty()) return 1.0;
  std::vector<double> deviations;
  for (const int index : inliers) {
    deviations.push_back(std::abs(ratios[index].log_ratio - log_ratio) /
                         ratios[index].log_ratio_stddev);
  }
  const double count = static_cast<double>(inliers.size());
  const double spread =
      kStddevOfMedianDeviation * Median(std::move(deviations));
  return 2.0 * std::sqrt((count * spread * spread + kPriorCount) /
                         (count + kPriorCount));
}

Measurements Measure(const TripletView& triplet, const RatioSupport& support,
                     const InlierThresholds& thresholds, const Inliers& inliers,
                     double log_ratio) {
  Measurements measurements;
  measurements.groups.resize(kFeatureKinds.size());
  const auto add = [&](FeatureKind kind, const Indices& of_kind,
                       double threshold_px) {
    if (!(threshold_px > 0)) return;
    const std::vector<RatioCandidate>& ratios = support.Ratios(kind);
    RatioGroup& group = measurements.groups[static_cast<std::size_t>(kind)];
    group.count = static_cast<int>(NumOf(support, kind, thresholds));
    // The deviations of points are those of one pixel.
    if (kind == FeatureKind::kPoint) group.prior_count = 0.25;
    group.noise = InitialNoise(ratios, of_kind, log_ratio);
    for (int n = 0; n < group.count; ++n) {
      const RatioCandidate& ratio = ratios[n];
      const double stddev = ratio.log_ratio_stddev;
      group.sum_of_stddevs += stddev;
      if (!(std::abs(ratio.log_ratio - log_ratio) <
            kRefinementReach * group.noise * stddev)) {
        continue;
      }
      RatioFeature feature;
      feature.log_ratio = ratio.log_ratio;
      feature.log_ratio_stddev = stddev;
      feature.group = static_cast<int>(kind);
      feature.cell = CellOf(support, triplet, kind, n);
      if (kind == FeatureKind::kCoplanar) {
        const CoplanarPairCandidate& pair = support.Pair(n);
        const CoplanarNoise noise =
            NoiseOfCoplanarRatio(triplet.geometry, triplet.lines_ij[pair.first],
                                 triplet.lines_jk[pair.last]);
        feature.first_line = support.FirstLineOf(n);
        feature.last_line = support.LastLineOf(n);
        feature.by_first = noise.by_first;
        feature.by_last = noise.by_last;
      }
      measurements.features.push_back(feature);
      measurements.of_kind.push_back({kind, n, 0.0});
    }
  };
  add(FeatureKind::kPoint, inliers.points, thresholds.points_px);
  add(FeatureKind::kLine, inliers.lines, thresholds.lines_px);
  add(FeatureKind::kCoplanar, inliers.pairs, thresholds.coplanar_px);
  add(FeatureKind::kPlanePoint, inliers.plane_points,
      thresholds.plane_points_px);
  return measurements;
}

}  // namespace

ScaleRatio EmptyRatio(const TripletView& triplet, const RatioSupport& support) {
  ScaleRatio ratio;
  ratio.views = triplet.views;
  ratio.points.candidates = support.num_points();
  ratio.lines.candidates = support.num_lines();
  ratio.coplanar.candidates = support.num_pairs() + support.num_plane_points();
  ratio.num_rejected_negative = support.num_rejected_negative();
  return ratio;
}

void RefineOnInliers(const TripletView& triplet, const RatioSupport& support,
                     const InlierThresholds& thresholds, double log_ratio,
                     ScaleRatio* ratio) {
  Measurements measurements =
      Measure(triplet, support, thresholds,
              FindInliers(support, thresholds, log_ratio), log_ratio);
  const RefinedRatio refined =
      RefineRatio(measurements.features, measurements.groups, log_ratio);
  std::vector<WeightedFeature> features;
  for (std::size_t n = 0; n < measurements.of_kind.size(); ++n) {
    if (refined.probability[n] < 0.5) continue;
    features.push_back(measurements.of_kind[n]);
    features.back().weight = refined.weight[n];
  }
  const Inliers inliers = FindInliers(support, thresholds, refined.log_ratio);
  ratio->log_ratio = refined.log_ratio;
  const double stddev =
      std::sqrt(refined.log_ratio_stddev * refined.log_ratio_stddev +
                PoseVariance(triplet, support, features));
  ratio->log_ratio_stddev = std::isfinite(stddev) ? stddev : kMaxLogRatioStddev;
  const auto share = [&](FeatureKind kind) {
    return refined.information_share[static_cast<std::size_t>(kind)];
  };
  ratio->points.information_share = share(FeatureKind::kPoint);
  ratio->lines.information_share = share(FeatureKind::kLine);
  ratio->coplanar.information_share =
      share(FeatureKind::kCoplanar) + share(FeatureKind::kPlanePoint);
  ratio->points.inliers = static_cast<int>(inliers.points.size());
  ratio->lines.inliers = static_cast<int>(inliers.lines.size());
  ratio->coplanar.inliers =
      static_cast<int>(inliers.pairs.size() + inliers.plane_points.size());
  ratio->points.threshold_px = thresholds.points_px;
  ratio->lines.threshold_px = thresholds.lines_px;
  ratio->coplanar.threshold_px = thresholds.coplanar_px > 0
                                     ? thresholds.coplanar_px
                                     : thresholds.plane_points_px;
  ratio->coplanar_inliers.clear();
  for (const int index : inliers.pairs) {
    const CoplanarPairCandidate& pair = support.Pair(index);
    ratio->coplanar_inliers.push_back(
        {triplet.lines_ij[pair.first].segment_in_middle,
         triplet.lines_jk[pair.last].segment_in_middle});
  }
}

}  // namespace lowlap
