#include "lowlap/adjustment/internal/structure/line_track.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lowlap/adjustment/internal/structure/line_refinement.h"
#include "lowlap/adjustment/internal/structure/pair_sampling.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// Rays that meet the line at less than 3 degrees do not tell where.
constexpr double kMinRaySine = 0.05;

struct Interval {
  double low = kInfinity;
  double high = -kInfinity;

  void Include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool IsEmpty() const { return !(low < high); }
};

// Where on the line the viewing ray of an end point passes, from `point`;
// nullopt for a ray along the line. `depth` is that along the ray.
std::optional<double> Lift(const RigidTransform& cam_from_world,
                           const Vec3& ray_in_cam, const Vec3& point,
                           const Vec3& direction, double min_sine,
                           double* depth) {
  const Vec3 ray = (cam_from_world.rotation.transpose() * ray_in_cam);
  const Vec3 unit_ray = ray.normalized();
  const Vec3 n = unit_ray.cross(direction);
  const double n2 = n.squaredNorm();
  if (!(n2 > min_sine * min_sine)) return std::nullopt;
  const Vec3 arm = point - cam_from_world.Center();
  // Closest points of center + z ray and point + s direction.
  *depth = arm.cross(direction).dot(n) / n2;
  return arm.cross(unit_ray).dot(n) / n2;
}

struct LineAgreement {
  std::vector<char> used;
  int count = 0;
  double squares = 0;

  bool BetterThan(const LineAgreement& other) const {
    return count != other.count ? count > other.count : squares < other.squares;
  }
};

LineAgreement AgreeOnLine(const CameraSet& cameras, const LineTrackState& track,
                          const Vec3& point, const Vec3& direction,
                          double threshold_px) {
  LineAgreement agreement;
  agreement.used.assign(track.candidates.size(), 0);
  for (std::size_t n = 0; n < track.candidates.size(); ++n) {
    const double error =
        LineErrorPx(cameras, track.candidates[n], point, direction);
    if (!(error <= threshold_px) || error == kInfinity) continue;
    agreement.used[n] = 1;
    ++agreement.count;
    agreement.squares += error * error;
  }
  return agreement;
}

int CountPoses(const CameraSet& cameras, const LineTrackState& track,
               const std::vector<char>& used) {
  std::set<int> poses;
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (used[n]) poses.insert(cameras.views[track.candidates[n].view].pose);
  }
  return static_cast<int>(poses.size());
}

std::vector<LineMeasurement> Measurements(const CameraSet& cameras,
                                          const LineTrackState& track,
                                          const std::vector<char>& used) {
  std::vector<LineMeasurement> measurements;
  for (std::size_t n = 0; n < used.size(); ++n) {
    if (!used[n]) continue;
    const LineCandidate& candidate = track.candidates[n];
    measurements.push_back({cameras.PoseOf(candidate.view).CamFromWorld(),
                            &candidate.rays, candidate.weight});
  }
  return measurements;
}

// The line of two interpretation planes, with `point` amid the first segment.
bool LineFromPair(const CameraSet& cameras, const LineCandidate& a,
                  const LineCandidate& b, Vec3* point, Vec3* direction) {
  const RigidTransform a_from_world = cameras.PoseOf(a.view).CamFromWorld();
  const RigidTransform b_from_world = cameras.PoseOf(b.view).CamFromWorld();
  const std::optional<PluckerLine> line =
      LineFromTwoViews(b_from_world * a_from_world.Inverse(), a.rays.normal,
                       b.rays.normal, 1e-6);
  if (!line) return false;
  const RigidTransform world_from_a = a_from_world.Inverse();
  const Vec3 middle =
      a.rays.ends[0].ray.normalized() + a.rays.ends[1].ray.normalized();
  const std::optional<Vec3> in_a = ClosestPointToRay(*line, middle, 1e-6);
  if (!in_a) return false;
  *point = world_from_a * *in_a;
  *direction = world_from_a.rotation * line->direction;
  return point->allFinite() && direction->allFinite();
}

// Share of the shorter of the two extents (one per pose) that both cover.
double TwoViewOverlap(const CameraSet& cameras, const LineTrackState& track) {
  std::map<int, Interval> extents;
  for (const LineCandidate& candidate : track.candidates) {
    if (!candidate.used) continue;
    Interval& extent = extents[cameras.views[candidate.view].pose];
    for (const EndPointRay& end : candidate.rays.ends) {
      double depth;
      const std::optional<double> at =
          Lift(cameras.PoseOf(candidate.view).CamFromWorld(), end.ray,
               track.point, track.direction, 1e-6, &depth);
      if (at) extent.Include(*at);
    }
  }
  if (extents.size() != 2) return 1;
  const Interval &a = extents.begin()->second, &b = extents.rbegin()->second;
  if (a.IsEmpty() || b.IsEmpty()) return 0;
  const double common = std::min(a.high, b.high) - std::max(a.low, b.low);
  return common / std::min(a.high - a.low, b.high - b.low);
}

std::optional<Eigen::Matrix4d> UnitCovariance(
    const std::vector<LineMeasurement>& measurements, const Vec3& point,
    const Vec3& direction) {
  Eigen::Matrix4d hessian;
  LineNormalEquations(measurements, point, direction, &hessian, nullptr);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(hessian);
  if (!(eigen.eigenvalues()(0) > 1e-15 * eigen.eigenvalues()(3))) {
    return std::nullopt;
  }
  return Eigen::Matrix4d(eigen.eigenvectors() *
                         eigen.eigenvalues().cwiseInverse().asDiagonal() *
                         eigen.eigenvectors().transpose());
}

// Standard deviation of the line across itself, over the distance from the
// nearest camera, at the worse end of its extent.
double RelativeLineStddev(const std::vector<LineMeasurement>& measurements,
                          const LineTrackState& track, double noise_px) {
  const std::optional<Eigen::Matrix4d> covariance =
      UnitCovariance(measurements, track.point, track.direction);
  if (!covariance) return kInfinity;
  double worst = 0;
  for (const double at : {track.low, track.high}) {
    Eigen::Matrix<double, 2, 4> across;
    across << Mat2::Identity(), at * Mat2::Identity();
    const Mat2 spread = across * *covariance * across.transpose();
    const double variance =
        Eigen::SelfAdjointEigenSolver<Mat2>(spread, Eigen::EigenvaluesOnly)
            .eigenvalues()(1);
    double distance = kInfinity;
    for (const LineMeasurement& measurement : measurements) {
      distance = std::min(distance, (measurement.cam_from_world *
                                     (track.point + at * track.direction))
                                        .norm());
    }
    worst = std::max(worst, noise_px * std::sqrt(variance) / distance);
  }
  return std::isfinite(worst) ? worst : kInfinity;
}

}  // namespace

int LineTrackState::UsedCount() const {
  return static_cast<int>(
      std::count_if(candidates.begin(), candidates.end(),
                    [](const LineCandidate& c) { return c.used; }));
}

int LineTrackState::PoseCount(const CameraSet& cameras) const {
  std::vector<char> used;
  for (const LineCandidate& candidate : candidates) {
    used.push_back(candidate.used);
  }
  return CountPoses(cameras, *this, used);
}

double LineErrorPx(const CameraSet& cameras, const LineCandidate& candidate,
                   const Vec3& point, const Vec3& direction) {
  const RigidTransform cam_from_world =
      cameras.PoseOf(candidate.view).CamFromWorld();
  const Vec3 normal = cam_from_world.rotation *
                      (point - cam_from_world.Center()).cross(direction);
  double squares = 0;
  for (const EndPointRay& end : candidate.rays.ends) {
    const double distance = EndPointDistancePx(end, normal, nullptr);
    squares += distance * distance;
    double depth = 1;
    Lift(cam_from_world, end.ray, point, direction, 1e-6, &depth);
    if (!(depth > 0)) return kInfinity;
  }
  const double error = candidate.weight * std::sqrt(0.5 * squares);
  return std::isfinite(error) ? error : kInfinity;
}

std::optional<LineEstimate> EstimateFromSegments(const CameraSet& cameras,
                                                 const LineTrackState& track) {
  std::vector<char> used;
  for (const LineCandidate& candidate : track.candidates) {
    used.push_back(candidate.used);
  }
  const std::vector<LineMeasurement> measurements =
      Measurements(cameras, track, used);
  LineEstimate estimate;
  estimate.point = track.point;
  estimate.direction = track.direction;
  RefineLine(measurements, &estimate.point, &estimate.direction);
  const std::optional<Eigen::Matrix4d> covariance =
      UnitCovariance(measurements, estimate.point, estimate.direction);
  if (!covariance) return std::nullopt;
  estimate.unit_covariance = *covariance;
  return estimate;
}

void UpdateLineExtent(const CameraSet& cameras, LineTrackState* track) {
  track->direction.normalize();
  Interval extent;
  for (const double min_sine : {kMinRaySine, 1e-6}) {
    for (const LineCandidate& candidate : track->candidates) {
      if (!candidate.used) continue;
      for (const EndPointRay& end : candidate.rays.ends) {
        double depth;
        const std::optional<double> at =
            Lift(cameras.PoseOf(candidate.view).CamFromWorld(), end.ray,
                 track->point, track->direction, min_sine, &depth);
        if (at && depth > 0) extent.Include(*at);
      }
    }
    if (!extent.IsEmpty()) break;
  }
  if (extent.IsEmpty()) extent = {0, 0};
  const double middle = 0.5 * (extent.low + extent.high);
  track->point += middle * track->direction;
  track->low = extent.low - middle;
  track->high = extent.high - middle;
}

void TriangulateLineTrack(const CameraSet& cameras,
                          const LineTriangulationLimits& limits,
                          LineTrackState* track) {
  std::vector<LineCandidate>& candidates = track->candidates;
  for (LineCandidate& candidate : candidates) candidate.used = false;
  if (CountPoses(cameras, *track, std::vector<char>(candidates.size(), 1)) <
      2) {
    track->status = LandmarkStatus::kTooFewViews;
    return;
  }

  Vec3 point, direction;
  LineAgreement best;
  bool degenerate = false;
  for (const auto& [a, b] : SamplePairs(candidates.size(), track->id.value())) {
    const LineCandidate &first = candidates[a], &second = candidates[b];
    if (cameras.views[first.view].pose == cameras.views[second.view].pose) {
      continue;
    }
    Vec3 pair_point, pair_direction;
    if (!LineFromPair(cameras, first, second, &pair_point, &pair_direction)) {
      degenerate = true;
      continue;
    }
    LineAgreement agreement = AgreeOnLine(cameras, *track, pair_point,
                                          pair_direction, limits.threshold_px);
    if (agreement.count < 2 || !agreement.BetterThan(best)) continue;
    best = std::move(agreement);
    point = pair_point;
    direction = pair_direction;
  }
  if (best.count < 2) {
    track->status = degenerate              ? LandmarkStatus::kUncertain
                    : candidates.size() > 2 ? LandmarkStatus::kInconsistent
                                            : LandmarkStatus::kBehindCamera;
    return;
  }
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    Vec3 refined_point = point, refined_direction = direction;
    RefineLine(Measurements(cameras, *track, best.used), &refined_point,
               &refined_direction);
    LineAgreement next = AgreeOnLine(cameras, *track, refined_point,
                                     refined_direction, limits.threshold_px);
    if (next.count < 2 || best.BetterThan(next)) break;
    const bool settled = next.used == best.used;
    point = refined_point;
    direction = refined_direction;
    best = std::move(next);
    if (settled) break;
  }

  const int pose_count = CountPoses(cameras, *track, best.used);
  if (pose_count < 2) {
    track->status = LandmarkStatus::kInconsistent;
    return;
  }
  track->point = point;
  track->direction = direction;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    candidates[n].used = best.used[n] != 0;
  }
  UpdateLineExtent(cameras, track);
  track->status = LandmarkStatus::kLandmark;
  if (!(RelativeLineStddev(Measurements(cameras, *track, best.used), *track,
                           limits.noise_px) <=
        limits.max_relative_depth_stddev)) {
    track->status = LandmarkStatus::kUncertain;
  } else if (pose_count == 2 && !(TwoViewOverlap(cameras, *track) >=
                                  limits.min_two_view_overlap)) {
    track->status = LandmarkStatus::kImplausible;
  }
  if (!track->IsLandmark()) {
    for (LineCandidate& candidate : candidates) candidate.used = false;
  }
}

}  // namespace lowlap
