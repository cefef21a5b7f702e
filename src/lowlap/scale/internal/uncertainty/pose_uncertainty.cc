#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "lowlap/geometry/rotation.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/trifocal_line.h"
#include "lowlap/scale/evidence/internal/trifocal_point.h"

namespace lowlap {
namespace {

// At most 24 of a kind, evenly spaced, with their weights made up for.
std::vector<WeightedFeature> Sample(
    const std::vector<WeightedFeature>& features) {
  constexpr std::size_t kMaxOfKind = 24;
  std::vector<WeightedFeature> sample;
  for (const FeatureKind kind : kFeatureKinds) {
    std::vector<WeightedFeature> of_kind;
    for (const WeightedFeature& feature : features) {
      if (feature.kind == kind) of_kind.push_back(feature);
    }
    const std::size_t num = std::min(kMaxOfKind, of_kind.size());
    for (std::size_t n = 0; n < num; ++n) {
      sample.push_back(of_kind[(2 * n + 1) * of_kind.size() / (2 * num)]);
      sample.back().weight *= static_cast<double>(of_kind.size()) / num;
    }
  }
  return sample;
}

RatioCandidate RatioIn(const TripletGeometry& geometry,
                       const TrifocalPointSolver& of_points,
                       const TripletView& triplet, const RatioSupport& support,
                       const WeightedFeature& feature) {
  switch (feature.kind) {
    case FeatureKind::kPoint:
      return of_points.Ratio(triplet.points[support.PointOf(feature.index)]);
    case FeatureKind::kLine:
      return TrifocalLineRatio(geometry,
                               triplet.lines[support.LineOf(feature.index)]);
    case FeatureKind::kPlanePoint:
      return of_points.Ratio(triplet.plane_points[feature.index].point);
    case FeatureKind::kCoplanar:
      break;
  }
  const CoplanarPairCandidate& pair = support.Pair(feature.index);
  return CoplanarRatio(geometry, triplet.lines_ij[pair.first],
                       triplet.lines_jk[pair.last]);
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
    const Eigen::Matrix<double, 5, 1> error =
        std::sqrt(std::max(0.0, eigen.eigenvalues()(axis))) *
        eigen.eigenvectors().col(axis);
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
  return perturbed;
}

double PoseVariance(const TripletView& triplet, const RatioSupport& support,
                    const std::vector<WeightedFeature>& features) {
  double variance = 0;
  if (triplet.pose_perturbations.empty()) return variance;
  const std::vector<WeightedFeature> sample = Sample(features);
  for (const TripletGeometry& geometry : triplet.pose_perturbations) {
    const TrifocalPointSolver of_points(geometry);
    double sum = 0, weights = 0;
    for (const WeightedFeature& feature : sample) {
      const RatioCandidate ratio =
          RatioIn(geometry, of_points, triplet, support, feature);
      if (ratio.status != CandidateStatus::kValid) continue;
      const double change =
          ratio.log_ratio -
          support.Ratios(feature.kind)[feature.index].log_ratio;
      sum += feature.weight * change;
      weights += feature.weight;
    }
    if (weights > 0) variance += (sum / weights) * (sum / weights);
  }
  return variance;
}

}  // namespace lowlap
