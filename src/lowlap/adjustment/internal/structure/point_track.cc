#include "lowlap/adjustment/internal/structure/point_track.h"

#include <Eigen/Dense>
#include <cmath>

#include "lowlap/adjustment/internal/costs/projection.h"
#include "lowlap/geometry/internal/triangulation.h"

namespace lowlap {
namespace {

// A candidate with what the geometry needs of its camera.
struct Observation {
  Observation(const CameraSet& cameras, const PointCandidate& of_candidate)
      : cam_from_world(cameras.PoseOf(of_candidate.view).CamFromWorld()),
        intrinsic(cameras.IntrinsicOf(of_candidate.view)),
        candidate(of_candidate) {}

  RigidTransform cam_from_world;
  const IntrinsicState& intrinsic;
  const PointCandidate& candidate;
};

std::optional<Vec2> DifferencePx(const Observation& observation,
                                 const Vec3& position) {
  return ProjectionErrorPx(observation.intrinsic.value,
                           observation.cam_from_world * position,
                           observation.candidate.pixel_px);
}

double WhitenedErrorPx(const Observation& observation, const Vec3& position) {
  const std::optional<Vec2> difference_px = DifferencePx(observation, position);
  return difference_px
             ? (observation.candidate.whitening * *difference_px).norm()
             : kInfinity;
}

// For FitLandmark.
class PointModel {
 public:
  using Place = Vec3;
  static constexpr bool kAllEndSearch = true;

  PointModel(const CameraSet& cameras, const PointTrackState& track)
      : cameras_(cameras) {
    observations_.reserve(track.candidates.size());
    for (const PointCandidate& candidate : track.candidates) {
      observations_.emplace_back(cameras, candidate);
      bearings_.push_back(
          observations_.back().intrinsic.value.Bearing(candidate.pixel_px));
    }
  }

  std::size_t size() const { return observations_.size(); }
  // Whether pairs failed for meeting behind a camera.
  bool met_behind() const { return met_behind_; }

  double ErrorPx(std::size_t n, const Vec3& position) const {
    return WhitenedErrorPx(observations_[n], position);
  }

  std::optional<Vec3> FromPair(std::size_t a, std::size_t b) {
    const Observation &first = observations_[a], &second = observations_[b];
    if (cameras_.views[first.candidate.view].pose ==
            cameras_.views[second.candidate.view].pose ||
        !bearings_[a] || !bearings_[b]) {
      return std::nullopt;
    }
    const RigidTransform world_from_first = first.cam_from_world.Inverse();
    const std::optional<Vec3> in_first = TriangulateMidpoint(
        second.cam_from_world * world_from_first, *bearings_[a], *bearings_[b]);
    if (!in_first) {
      met_behind_ = true;
      return std::nullopt;
    }
    std::vector<char> pair(size(), 0);
    pair[a] = pair[b] = 1;
    return Refine(pair, world_from_first * *in_first);
  }

  std::optional<Vec3> Refine(const std::vector<char>& used,
                             Vec3 position) const {
    constexpr int kIterations = 8;
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      Mat3 hessian;
      Vec3 gradient;
      if (!Linearise(used, position, &hessian, &gradient)) return std::nullopt;
      const Vec3 step = hessian.ldlt().solve(gradient);
      if (!step.allFinite()) return std::nullopt;
      position -= step;
      if (step.norm() <= 1e-10 * position.norm()) break;
    }
    return position;
  }

  std::optional<Mat3> UnitCovariance(const std::vector<char>& used,
                                     const Vec3& position) const {
    Mat3 hessian;
    Vec3 gradient;
    if (!Linearise(used, position, &hessian, &gradient)) return std::nullopt;
    const Mat3 covariance = hessian.inverse();
    if (!covariance.allFinite()) return std::nullopt;
    return covariance;
  }

  // Largest standard deviation of the position over its least distance from a
  // camera that sees it.
  double RelativeStddev(const std::vector<char>& used, const Vec3& position,
                        double noise_px) const {
    Mat3 hessian;
    Vec3 gradient;
    if (!Linearise(used, position, &hessian, &gradient)) return kInfinity;
    double distance = kInfinity;
    for (std::size_t n = 0; n < size(); ++n) {
      if (!used[n]) continue;
      distance = std::min(distance,
                          (observations_[n].cam_from_world * position).norm());
    }
    const double least =
        Eigen::SelfAdjointEigenSolver<Mat3>(hessian, Eigen::EigenvaluesOnly)
            .eigenvalues()(0);
    return least > 0 ? noise_px / (std::sqrt(least) * distance) : kInfinity;
  }

 private:
  // Normal equations of the whitened errors; false if a point is not visible.
  bool Linearise(const std::vector<char>& used, const Vec3& position,
                 Mat3* hessian, Vec3* gradient) const {
    hessian->setZero();
    gradient->setZero();
    for (std::size_t n = 0; n < size(); ++n) {
      if (!used[n]) continue;
      const Observation& observation = observations_[n];
      const Mat2& whitening = observation.candidate.whitening;
      const Vec3 x_cam = observation.cam_from_world * position;
      const Intrinsic& intrinsic = observation.intrinsic.value;
      if (!IsProjectable(intrinsic.model, x_cam)) return false;
      Mat23 by_x_cam;
      Vec2 difference_px =
          ProjectPoint(intrinsic, observation.intrinsic.parameters.data(),
                       x_cam, &by_x_cam) -
          observation.candidate.pixel_px;
      WrapPanorama(intrinsic, &difference_px);
      const Mat23 jacobian =
          whitening * by_x_cam * observation.cam_from_world.rotation;
      *hessian += jacobian.transpose() * jacobian;
      *gradient += jacobian.transpose() * (whitening * difference_px);
    }
    return true;
  }

  const CameraSet& cameras_;
  std::vector<Observation> observations_;
  std::vector<std::optional<Vec3>> bearings_;  // unit, in the camera
  bool met_behind_ = false;
};

}  // namespace

std::optional<Vec2> PointDifferencePx(const CameraSet& cameras,
                                      const PointCandidate& candidate,
                                      const Vec3& position) {
  return DifferencePx(Observation(cameras, candidate), position);
}

double DistancePx(const CameraSet& cameras, const PointTrackState& track,
                  const PointCandidate& candidate) {
  const std::optional<Vec2> difference_px =
      PointDifferencePx(cameras, candidate, track.position);
  return difference_px ? difference_px->norm() : kInfinity;
}

double ErrorPx(const CameraSet& cameras, const PointTrackState& track,
               const PointCandidate& candidate) {
  return WhitenedErrorPx(Observation(cameras, candidate), track.position);
}

void Triangulate(const CameraSet& cameras, const TriangulationLimits& limits,
                 PointTrackState* track) {
  track->Use(std::vector<char>(track->candidates.size(), 1));
  if (track->PoseCount(cameras) < 2) {
    return track->Abandon(LandmarkStatus::kTooFewViews);
  }
  PointModel model(cameras, *track);
  Agreement agreement;
  const std::optional<Vec3> position =
      FitLandmark(track->id.value(), limits.threshold_px, &model, &agreement);
  if (!position) {
    return track->Abandon(model.met_behind() ? LandmarkStatus::kBehindCamera
                                             : LandmarkStatus::kInconsistent);
  }
  track->Use(agreement.used);
  if (track->PoseCount(cameras) < 2) {
    return track->Abandon(LandmarkStatus::kInconsistent);
  }
  if (!(model.RelativeStddev(agreement.used, *position, limits.noise_px) <=
        limits.max_relative_depth_stddev)) {
    return track->Abandon(LandmarkStatus::kUncertain);
  }
  track->status = LandmarkStatus::kLandmark;
  track->position = *position;
}

std::optional<PointEstimate> EstimateFromPixels(const CameraSet& cameras,
                                                const PointTrackState& track) {
  const PointModel model(cameras, track);
  const std::vector<char> used = track.Used();
  const std::optional<Vec3> position = model.Refine(used, track.position);
  if (!position) return std::nullopt;
  const std::optional<Mat3> covariance = model.UnitCovariance(used, *position);
  if (!covariance) return std::nullopt;
  return PointEstimate{*position, *covariance};
}

}  // namespace lowlap
