#include "lowlap/scale/ratio_inliers.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/scale/coplanar_ratio.h"
#include "lowlap/scale/pose_uncertainty.h"
#include "lowlap/scale/ratio_refinement.h"

namespace lowlap {
namespace {

using Indices = std::vector<int>;

struct Inliers {
  Indices points;
  Indices lines;
  Indices pairs;
  Indices plane_points;

  bool operator==(const Inliers& other) const {
    return points == other.points && lines == other.lines &&
           pairs == other.pairs && plane_points == other.plane_points;
  }
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

Indices Within3Stddev(const RatioSupport& support, FeatureKind kind,
                      double threshold_px, const InlierThresholds& thresholds,
                      const RefinedRatio& refined) {
  Indices indices;
  if (!(threshold_px > 0)) return indices;
  const std::size_t group = static_cast<std::size_t>(kind);
  const double noise = group < refined.group_noise.size()
                           ? std::max(1.0, refined.group_noise[group])
                           : 1.0;
  for (std::size_t n = 0; n < NumOf(support, kind, thresholds); ++n) {
    const RatioCandidate& ratio = support.Ratios(kind)[n];
    if (std::abs(ratio.log_ratio - refined.log_ratio) <=
        3.0 * noise * ratio.log_ratio_stddev) {
      indices.push_back(static_cast<int>(n));
    }
  }
  return indices;
}

Inliers FindConsistent(const RatioSupport& support,
                       const InlierThresholds& thresholds,
                       const RefinedRatio& refined) {
  const auto within = [&](FeatureKind kind, double threshold_px) {
    return Within3Stddev(support, kind, threshold_px, thresholds, refined);
  };
  return {within(FeatureKind::kPoint, thresholds.points_px),
          within(FeatureKind::kLine, thresholds.lines_px),
          within(FeatureKind::kCoplanar, thresholds.coplanar_px),
          within(FeatureKind::kPlanePoint, thresholds.plane_points_px)};
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

// The inliers as measurements of the ratio, and as features with the weights
// they have among each other.
std::vector<RatioInlier> InlierRatios(const RatioSupport& support,
                                      const TripletView& triplet,
                                      const Inliers& inliers,
                                      std::vector<WeightedFeature>* features) {
  std::vector<RatioInlier> ratios;
  features->clear();
  const auto add = [&](FeatureKind kind, int index, double multiplicity) {
    const RatioCandidate& ratio = support.Ratios(kind)[index];
    const double stddev = ratio.log_ratio_stddev;
    ratios.push_back({ratio.log_ratio, stddev, static_cast<int>(kind),
                      multiplicity, CellOf(support, triplet, kind, index)});
    features->push_back({kind, index, 1.0 / (stddev * stddev * multiplicity)});
  };
  for (const int index : inliers.points) add(FeatureKind::kPoint, index, 1.0);
  for (const int index : inliers.lines) add(FeatureKind::kLine, index, 1.0);
  // Pairs that share a line share its noise. With n_a lines all paired with n_b
  // others, the mean of the two occurrence counts makes n_a n_b pairs count as
  // the harmonic mean of n_a and n_b.
  std::vector<int> first(triplet.lines_ij.size(), 0);
  std::vector<int> last(triplet.lines_jk.size(), 0);
  for (const int index : inliers.pairs) {
    ++first[support.Pair(index).first];
    ++last[support.Pair(index).last];
  }
  for (const int index : inliers.pairs) {
    const CoplanarPairCandidate& pair = support.Pair(index);
    add(FeatureKind::kCoplanar, index,
        0.5 * (first[pair.first] + last[pair.last]));
  }
  for (const int index : inliers.plane_points) {
    add(FeatureKind::kPlanePoint, index, 1.0);
  }
  return ratios;
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
  constexpr int kRounds = 4;
  std::vector<WeightedFeature> features;
  RefinedRatio refined = RefineRatio(
      InlierRatios(support, triplet,
                   FindInliers(support, thresholds, log_ratio), &features),
      log_ratio);
  Inliers consistent;
  for (int round = 0; round < kRounds; ++round) {
    Inliers next = FindConsistent(support, thresholds, refined);
    if (round > 0 && next == consistent) break;
    consistent = std::move(next);
    refined = RefineRatio(InlierRatios(support, triplet, consistent, &features),
                          refined.log_ratio);
  }
  const Inliers inliers = FindInliers(support, thresholds, refined.log_ratio);
  ratio->log_ratio = refined.log_ratio;
  ratio->log_ratio_stddev =
      std::sqrt(refined.log_ratio_stddev * refined.log_ratio_stddev +
                PoseVariance(triplet, support, features));
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
