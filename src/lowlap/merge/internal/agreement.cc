#include "lowlap/merge/internal/agreement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {
namespace {

struct Errors {
  double rotation_rad = 0;
  double direction_rad = 0;
};

Errors ErrorsOf(const RelativePose& measured, const Pose& first,
                const Pose& second) {
  const Vec3 baseline = second.rotation * (first.center - second.center);
  return {RotationAngleBetween(measured.rotation,
                               second.rotation * first.rotation.transpose()),
          AngleBetween(baseline, measured.direction)};
}

double LengthOf(const std::map<ViewId, Pose>& poses, ViewId a, ViewId b) {
  return (poses.at(a).center - poses.at(b).center).norm();
}

// Baselines shorter than this share of the extent are rounding. A camera that
// is far too far away does not make the others' so.
double ShortestBaseline(const std::map<ViewId, Pose>& poses) {
  constexpr double kShare = 1e-9;
  std::vector<double> x, y, z, distances;
  for (const auto& entry : poses) {
    x.push_back(entry.second.center.x());
    y.push_back(entry.second.center.y());
    z.push_back(entry.second.center.z());
  }
  const Vec3 middle(Median(std::move(x)), Median(std::move(y)),
                    Median(std::move(z)));
  for (const auto& entry : poses) {
    distances.push_back((entry.second.center - middle).norm());
  }
  return kShare * Median(std::move(distances));
}

// The errors that are not beyond `reach` of their stated deviations, if these
// are all too small by one factor, which the lower quartile tells: three in
// four errors may come from what is wrong with the poses.
template <int kDimension>
std::vector<std::size_t> NearErrors(const std::vector<double>& errors,
                                    const std::vector<double>& stddevs,
                                    double reach) {
  std::vector<double> normalised;
  for (std::size_t n = 0; n < errors.size(); ++n) {
    normalised.push_back(errors[n] / stddevs[n]);
  }
  std::vector<double> sorted = normalised;
  std::sort(sorted.begin(), sorted.end());
  const double factor =
      sorted.empty() ? 1
                     : std::max(1.0, sorted[(sorted.size() - 1) / 4] /
                                         kLowerQuartileOfNorm<kDimension>);
  std::vector<std::size_t> near;
  for (std::size_t n = 0; n < errors.size(); ++n) {
    if (normalised[n] <= reach * factor) near.push_back(n);
  }
  return near;
}

// Robust standard deviation per axis.
template <int kDimension>
double DeviationOf(const std::vector<double>& errors,
                   const std::vector<double>& stddevs, double reach) {
  std::vector<double> near;
  for (const std::size_t n : NearErrors<kDimension>(errors, stddevs, reach)) {
    near.push_back(errors[n]);
  }
  return Median(std::move(near)) / kMedianOfNorm<kDimension>;
}

// By how much the stated deviations are too small; at least 1.
double FactorOf(const std::vector<double>& errors,
                const std::vector<double>& stddevs, double reach) {
  std::vector<double> near;
  for (const std::size_t n : NearErrors<1>(errors, stddevs, reach)) {
    near.push_back(errors[n] / stddevs[n]);
  }
  return std::max(1.0, Median(std::move(near)) / kMedianOfNorm<1>);
}

}  // namespace

std::vector<PairAgreement> ComparePairs(
    const std::map<ViewPair, RelativePose>& relative_poses,
    const std::map<ViewId, Pose>& poses, const PoseOptions& options) {
  const double shortest = ShortestBaseline(poses);
  std::vector<PairAgreement> pairs;
  std::vector<double> rotations, rotation_stddevs, directions,
      direction_stddevs;
  for (const auto& [views, measured] : relative_poses) {
    const auto first = poses.find(views.first);
    const auto second = poses.find(views.second);
    if (first == poses.end() || second == poses.end() ||
        !(LengthOf(poses, views.first, views.second) > shortest)) {
      continue;
    }
    PairAgreement best;
    double least = HUGE_VAL;
    for (std::size_t n = 0; n < NumHypotheses(measured); ++n) {
      const RelativePose motion = WithHypothesis(measured, n);
      const Errors errors = ErrorsOf(motion, first->second, second->second);
      const double size =
          std::hypot(errors.rotation_rad / RotationStddev(motion),
                     errors.direction_rad / DirectionStddev(motion));
      if (!(size < least)) continue;
      least = size;
      best = {views, n, errors.rotation_rad, errors.direction_rad, 0, 0};
    }
    const RelativePose motion = WithHypothesis(measured, best.hypothesis);
    pairs.push_back(best);
    rotations.push_back(best.rotation_error_rad);
    rotation_stddevs.push_back(RotationStddev(motion));
    directions.push_back(best.direction_error_rad);
    direction_stddevs.push_back(DirectionStddev(motion));
  }
  const double reach = options.outlier_reach;
  // A model that is wrong throughout has large residuals everywhere: these do
  // not excuse it beyond what is called false.
  const ErrorLimits limits = LimitsOf(options);
  const double rotation_stddev =
      std::min(DeviationOf<3>(rotations, rotation_stddevs, reach),
               limits.least_false_rad);
  const double direction_stddev =
      std::min(DeviationOf<2>(directions, direction_stddevs, reach),
               3 * limits.least_false_rad);
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    pairs[n].rotation_limit_rad =
        limits.RotationRad(rotation_stddev, rotation_stddevs[n]);
    pairs[n].direction_limit_rad =
        limits.DirectionRad(direction_stddev, direction_stddevs[n]);
  }
  return pairs;
}

double LogRatioOf(const std::map<ViewId, Pose>& poses,
                  const ViewTriplet& views) {
  return std::log(LengthOf(poses, views.middle, views.last) /
                  LengthOf(poses, views.first, views.middle));
}

std::vector<RatioAgreement> CompareRatios(const std::vector<ScaleRatio>& ratios,
                                          const std::map<ViewId, Pose>& poses,
                                          const PoseOptions& options) {
  const double shortest = ShortestBaseline(poses);
  std::vector<RatioAgreement> compared;
  std::vector<double> errors, stddevs;
  for (const ScaleRatio& ratio : ratios) {
    const ViewTriplet& views = ratio.views;
    if (ratio.verdict != RatioVerdict::kMeaningful ||
        poses.count(views.first) == 0 || poses.count(views.middle) == 0 ||
        poses.count(views.last) == 0 ||
        !(LengthOf(poses, views.first, views.middle) > shortest) ||
        !(LengthOf(poses, views.middle, views.last) > shortest)) {
      continue;
    }
    compared.push_back({views, LogRatioOf(poses, views) - ratio.log_ratio, 0,
                        ratio.log10_nfa});
    errors.push_back(std::abs(compared.back().error));
    stddevs.push_back(std::max(ratio.log_ratio_stddev, kRatioErrorFloor));
  }
  // As DiagnosisOptions::max_stddev: less does not make a ratio useless.
  const double tenth = DiagnosisOptions().max_stddev;
  const double factor = FactorOf(errors, stddevs, options.outlier_reach);
  for (std::size_t n = 0; n < compared.size(); ++n) {
    const double excused =
        std::max(stddevs[n], std::min(factor * stddevs[n], tenth));
    compared[n].limit = std::max(options.outlier_reach * excused, tenth);
  }
  return compared;
}

}  // namespace lowlap
