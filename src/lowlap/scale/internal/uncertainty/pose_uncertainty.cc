#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/internal/candidate_limits.h"
#include "lowlap/scale/internal/criterion/even_rank.h"

namespace lowlap {
namespace {

// The candidates of one kind: at most 24, evenly spaced by rank of their ratios
// (whatever their order), with their weights made up for.
struct Sample {
  std::vector<int> candidates;
  std::vector<double> weights;
};

std::vector<Sample> SampleKinds(
    const RatioSupport& support,
    const std::vector<WeightedCandidate>& candidates) {
  constexpr std::size_t kMaxOfKind = 24;
  std::vector<Sample> samples(support.num_kinds());
  for (int k = 0; k < support.num_kinds(); ++k) {
    std::vector<WeightedCandidate> of_kind;
    for (const WeightedCandidate& candidate : candidates) {
      if (candidate.kind == k) of_kind.push_back(candidate);
    }
    const std::size_t num = std::min(kMaxOfKind, of_kind.size());
    if (num < of_kind.size()) {
      const auto rank = [&](const WeightedCandidate& candidate) {
        return std::make_pair(
            support.kind(k).ratios()[candidate.index].log_ratio,
            candidate.weight);
      };
      std::sort(of_kind.begin(), of_kind.end(),
                [&](const WeightedCandidate& a, const WeightedCandidate& b) {
                  return rank(a) < rank(b);
                });
    }
    for (std::size_t n = 0; n < num; ++n) {
      const WeightedCandidate& taken =
          of_kind[EvenRank(n, num, of_kind.size())];
      samples[k].candidates.push_back(taken.index);
      samples[k].weights.push_back(taken.weight *
                                   (static_cast<double>(of_kind.size()) / num));
    }
  }
  return samples;
}

// Of the log ratios in a geometry; nothing where none is left.
std::optional<double> ChangeOfMean(const TripletView& triplet,
                                   const RatioSupport& support,
                                   const std::vector<Sample>& samples,
                                   const TripletGeometry& geometry) {
  double sum = 0, weights = 0;
  for (int k = 0; k < support.num_kinds(); ++k) {
    const Sample& sample = samples[k];
    const std::vector<RatioCandidate> moved =
        support.kind(k).RatiosIn(triplet, geometry, sample.candidates);
    for (std::size_t n = 0; n < moved.size(); ++n) {
      if (moved[n].status != CandidateStatus::kValid) continue;
      const double change =
          moved[n].log_ratio -
          support.kind(k).ratios()[sample.candidates[n]].log_ratio;
      sum += sample.weights[n] * change;
      weights += sample.weights[n];
    }
  }
  if (!(weights > 0)) return std::nullopt;
  return sum / weights;
}

// Whether an error turns a camera so far that it has no standard deviation to
// speak of: large rotations do not add up.
bool TurnsFar(const TripletGeometry& geometry,
              const TripletGeometry& perturbed) {
  constexpr double kMaxTurn_rad = 0.5;
  return RotationAngleBetween(geometry.cami_from_camj.rotation,
                              perturbed.cami_from_camj.rotation) >
             kMaxTurn_rad ||
         RotationAngleBetween(geometry.camk_from_camj.rotation,
                              perturbed.camk_from_camj.rotation) > kMaxTurn_rad;
}

}  // namespace

std::vector<TripletGeometry> PerturbPose(const TripletGeometry& geometry,
                                         const RelativePose& edge,
                                         const ViewTriplet& views) {
  std::vector<TripletGeometry> perturbed;
  if (!edge.covariance || !edge.covariance->allFinite()) return perturbed;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 5, 5>> eigen(
      *edge.covariance);
  const double largest = eigen.eigenvalues()(4);
  if (!(eigen.eigenvalues()(0) >= -1e-9 * largest)) return perturbed;
  const bool is_ij =
      edge.views.first == views.first || edge.views.second == views.first;
  for (int axis = 0; axis < 5; ++axis) {
    const double stddev = std::sqrt(std::max(0.0, eigen.eigenvalues()(axis)));
    for (const double step : {stddev, -stddev}) {
      const Eigen::Matrix<double, 5, 1> error =
          step * eigen.eigenvectors().col(axis);
      RelativePose moved;
      moved.views = edge.views;
      moved.rotation = RotationFromAngleAxis(error.head<3>()) * edge.rotation;
      moved.direction =
          (edge.direction + TangentBasis(edge.direction) * error.tail<2>())
              .normalized();
      TripletGeometry moved_geometry = geometry;
      if (is_ij) {
        moved_geometry.cami_from_camj =
            UnitTransform(moved, views.middle, views.first);
      } else {
        moved_geometry.camk_from_camj =
            UnitTransform(moved, views.middle, views.last);
      }
      perturbed.push_back(moved_geometry);
    }
  }
  return perturbed;
}

double PoseVariance(const TripletView& triplet, const RatioSupport& support,
                    const std::vector<WeightedCandidate>& candidates) {
  if (candidates.empty()) return 0;
  const std::vector<Sample> samples = SampleKinds(support, candidates);
  const std::vector<TripletGeometry>& perturbed = triplet.pose_perturbations;
  double variance = 0;
  for (std::size_t n = 0; n + 1 < perturbed.size(); n += 2) {
    const auto there = ChangeOfMean(triplet, support, samples, perturbed[n]);
    const auto back = ChangeOfMean(triplet, support, samples, perturbed[n + 1]);
    if (TurnsFar(triplet.geometry, perturbed[n]) || (!there && !back)) {
      variance += kMaxLogRatioStddev * kMaxLogRatioStddev;
      continue;
    }
    for (const std::optional<double>& change : {there, back}) {
      if (change) variance += *change * *change / 2;
    }
  }
  return variance;
}

}  // namespace lowlap
