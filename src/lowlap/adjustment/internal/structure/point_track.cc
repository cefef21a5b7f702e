#include "lowlap/adjustment/internal/structure/point_track.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/adjustment/internal/costs/projection.h"
#include "lowlap/adjustment/internal/structure/pair_sampling.h"
#include "lowlap/geometry/internal/triangulation.h"

namespace lowlap {
namespace {

// A candidate with what the geometry needs of its camera.
struct Observation {
  RigidTransform cam_from_world;
  const IntrinsicState* intrinsic = nullptr;
  int pose = -1;
  Vec2 pixel_px = Vec2::Zero();
  Mat2 whitening = Mat2::Identity();
  Vec3 bearing = Vec3::Zero();  // unit, in the camera; zero if undefined
};

Observation MakeObservation(const CameraSet& cameras,
                            const PointCandidate& candidate) {
  Observation observation;
  observation.cam_from_world = cameras.PoseOf(candidate.view).CamFromWorld();
  observation.intrinsic = &cameras.IntrinsicOf(candidate.view);
  observation.pose = cameras.views[candidate.view].pose;
  observation.pixel_px = candidate.pixel_px;
  observation.whitening = candidate.whitening;
  return observation;
}

std::vector<Observation> MakeObservations(const CameraSet& cameras,
                                          const PointTrackState& track) {
  std::vector<Observation> observations;
  observations.reserve(track.candidates.size());
  for (const PointCandidate& candidate : track.candidates) {
    observations.push_back(MakeObservation(cameras, candidate));
    observations.back().bearing =
        observations.back()
            .intrinsic->value.Bearing(candidate.pixel_px)
            .value_or(Vec3::Zero());
  }
  return observations;
}

std::optional<Vec2> DifferencePx(const Observation& observation,
                                 const Vec3& position) {
  const Vec3 x_cam = observation.cam_from_world * position;
  const Intrinsic& intrinsic = observation.intrinsic->value;
  if (!IsProjectable(intrinsic.model, x_cam)) return std::nullopt;
  Vec2 difference_px = intrinsic.Project(x_cam) - observation.pixel_px;
  WrapPanorama(intrinsic, &difference_px);
  if (!difference_px.allFinite()) return std::nullopt;
  return difference_px;
}

double ErrorPx(const Observation& observation, const Vec3& position) {
  const std::optional<Vec2> difference_px = DifferencePx(observation, position);
  return difference_px ? (observation.whitening * *difference_px).norm()
                       : kInfinity;
}

// Normal equations of the whitened errors; false if a point is not visible.
bool Linearise(const std::vector<Observation>& observations,
               const std::vector<char>& used, const Vec3& position,
               Mat3* hessian, Vec3* gradient) {
  hessian->setZero();
  gradient->setZero();
  for (std::size_t n = 0; n < observations.size(); ++n) {
    if (!used[n]) continue;
    const Observation& observation = observations[n];
    Mat23 by_x_cam;
    const Vec3 x_cam = observation.cam_from_world * position;
    const Intrinsic& intrinsic = observation.intrinsic->value;
    if (!IsProjectable(intrinsic.model, x_cam)) return false;
    Vec2 difference_px =
        ProjectPoint(intrinsic, observation.intrinsic->parameters.data(), x_cam,
                     &by_x_cam) -
        observation.pixel_px;
    WrapPanorama(intrinsic, &difference_px);
    const Mat23 jacobian =
        observation.whitening * by_x_cam * observation.cam_from_world.rotation;
    *hessian += jacobian.transpose() * jacobian;
    *gradient += jacobian.transpose() * (observation.whitening * difference_px);
  }
  return true;
}

std::optional<Vec3> Refine(const std::vector<Observation>& observations,
                           const std::vector<char>& used, Vec3 position) {
  constexpr int kIterations = 8;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Mat3 hessian;
    Vec3 gradient;
    if (!Linearise(observations, used, position, &hessian, &gradient)) {
      return std::nullopt;
    }
    const Vec3 step = hessian.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    position -= step;
    if (step.norm() <= 1e-10 * position.norm()) break;
  }
  return position;
}

struct Agreement {
  std::vector<char> used;
  int count = 0;
  double squares = 0;

  bool BetterThan(const Agreement& other) const {
    return count != other.count ? count > other.count : squares < other.squares;
  }
};

Agreement Agree(const std::vector<Observation>& observations,
                const Vec3& position, double threshold_px) {
  Agreement agreement;
  agreement.used.assign(observations.size(), 0);
  for (std::size_t n = 0; n < observations.size(); ++n) {
    const double error = ErrorPx(observations[n], position);
    if (!(error <= threshold_px) || error == kInfinity) continue;
    agreement.used[n] = 1;
    ++agreement.count;
    agreement.squares += error * error;
  }
  return agreement;
}

// Largest standard deviation of the position over its least distance from a
// camera that sees it.
double RelativeStddev(const std::vector<Observation>& observations,
                      const std::vector<char>& used, const Vec3& position,
                      double noise_px) {
  Mat3 hessian;
  Vec3 gradient;
  if (!Linearise(observations, used, position, &hessian, &gradient)) {
    return kInfinity;
  }
  double distance = kInfinity;
  for (std::size_t n = 0; n < observations.size(); ++n) {
    if (!used[n]) continue;
    distance =
        std::min(distance, (observations[n].cam_from_world * position).norm());
  }
  const double least =
      Eigen::SelfAdjointEigenSolver<Mat3>(hessian, Eigen::EigenvaluesOnly)
          .eigenvalues()(0);
  return least > 0 ? noise_px / (std::sqrt(least) * distance) : kInfinity;
}

bool SpansTwoPoses(const std::vector<Observation>& observations,
                   const std::vector<char>& used) {
  int first_pose = -1;
  for (std::size_t n = 0; n < observations.size(); ++n) {
    if (!used[n]) continue;
    if (first_pose >= 0 && observations[n].pose != first_pose) return true;
    first_pose = observations[n].pose;
  }
  return false;
}

std::optional<Vec3> TriangulatePair(const Observation& a,
                                    const Observation& b) {
  const std::optional<Vec3> in_a = TriangulateMidpoint(
      b.cam_from_world * a.cam_from_world.Inverse(), a.bearing, b.bearing);
  if (!in_a) return std::nullopt;
  return a.cam_from_world.Inverse() * *in_a;
}

// The refined point of the best pair; `behind` tells whether pairs failed for
// meeting behind a camera.
std::optional<Vec3> FromBestPair(const std::vector<Observation>& observations,
                                 double threshold_px, PointTrackId id,
                                 bool* behind) {
  std::optional<Vec3> best_position;
  Agreement best;
  for (const auto& [a, b] : SamplePairs(observations.size(), id.value())) {
    const Observation &first = observations[a], &second = observations[b];
    if (first.pose == second.pose || first.bearing.isZero() ||
        second.bearing.isZero()) {
      continue;
    }
    std::optional<Vec3> position = TriangulatePair(first, second);
    if (!position) {
      *behind = true;
      continue;
    }
    std::vector<char> pair(observations.size(), 0);
    pair[a] = pair[b] = 1;
    position = Refine(observations, pair, *position);
    if (!position) continue;
    const Agreement agreement = Agree(observations, *position, threshold_px);
    if (agreement.count >= 2 &&
        (!best_position || agreement.BetterThan(best))) {
      best = agreement;
      best_position = position;
      if (best.count == static_cast<int>(observations.size())) break;
    }
  }
  return best_position;
}

}  // namespace

int PointTrackState::UsedCount() const {
  return static_cast<int>(
      std::count_if(candidates.begin(), candidates.end(),
                    [](const PointCandidate& c) { return c.used; }));
}

bool PointTrackState::HasTwoPoses(const CameraSet& cameras) const {
  int first_pose = -1;
  for (const PointCandidate& candidate : candidates) {
    if (!candidate.used) continue;
    const int pose = cameras.views[candidate.view].pose;
    if (first_pose >= 0 && pose != first_pose) return true;
    first_pose = pose;
  }
  return false;
}

std::optional<Vec2> PointDifferencePx(const CameraSet& cameras,
                                      const PointCandidate& candidate,
                                      const Vec3& position) {
  return DifferencePx(MakeObservation(cameras, candidate), position);
}

double PointErrorPx(const CameraSet& cameras, const PointCandidate& candidate,
                    const Vec3& position) {
  return ErrorPx(MakeObservation(cameras, candidate), position);
}

void TriangulatePointTrack(const CameraSet& cameras,
                           const PointTriangulationLimits& limits,
                           PointTrackState* track) {
  for (PointCandidate& candidate : track->candidates) candidate.used = false;
  const std::vector<Observation> observations =
      MakeObservations(cameras, *track);
  const std::vector<char> all(observations.size(), 1);
  if (!SpansTwoPoses(observations, all)) {
    track->status = LandmarkStatus::kTooFewViews;
    return;
  }

  bool behind = false;
  std::optional<Vec3> position =
      FromBestPair(observations, limits.threshold_px, track->id, &behind);
  if (!position) {
    track->status =
        behind ? LandmarkStatus::kBehindCamera : LandmarkStatus::kInconsistent;
    return;
  }
  // Refining on all that agree lets others agree, or some not.
  Agreement agreement = Agree(observations, *position, limits.threshold_px);
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const std::optional<Vec3> refined =
        Refine(observations, agreement.used, *position);
    if (!refined) break;
    Agreement next = Agree(observations, *refined, limits.threshold_px);
    if (next.count < 2 || agreement.BetterThan(next)) break;
    const bool settled = next.used == agreement.used;
    position = refined;
    agreement = std::move(next);
    if (settled) break;
  }
  if (!SpansTwoPoses(observations, agreement.used)) {
    track->status = LandmarkStatus::kInconsistent;
    return;
  }
  if (!(RelativeStddev(observations, agreement.used, *position,
                       limits.noise_px) <= limits.max_relative_depth_stddev)) {
    track->status = LandmarkStatus::kUncertain;
    return;
  }
  track->status = LandmarkStatus::kLandmark;
  track->position = *position;
  for (std::size_t n = 0; n < observations.size(); ++n) {
    track->candidates[n].used = agreement.used[n] != 0;
  }
}

}  // namespace lowlap
