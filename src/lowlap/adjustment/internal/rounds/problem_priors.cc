#include <algorithm>

#include "lowlap/adjustment/internal/costs/direction_cost.h"
#include "lowlap/adjustment/internal/costs/plane_costs.h"
#include "lowlap/adjustment/internal/rounds/problem_builder.h"

// What holds the unknowns of a problem together besides their observations.

namespace lowlap {

void ProblemBuilder::AddPlanes() {
  // Of what is close to a plane and not on it no threshold tells: the loss
  // bends early, at half the thickness.
  constexpr double kLossScale = 0.5;
  losses_.push_back(std::make_unique<ceres::CauchyLoss>(kLossScale));
  ceres::LossFunction* loss = losses_.back().get();
  // The first camera that sees the landmark.
  const auto pose_of = [&](const auto& track) -> int {
    const auto used =
        std::find_if(track.candidates.begin(), track.candidates.end(),
                     [](const auto& candidate) { return candidate.used; });
    return cameras_->views[used->view].pose;
  };
  for (const int p : selection_.planes) {
    const PlaneState& plane = state_->planes[p];
    const auto place_at = [&](const PlaneTie& tie, const Vec3& place,
                              int pose) {
      const Vec3 arm = place - plane.anchor;
      const double bow = arm.dot(plane.bend * arm);
      return PlaceOnPlane(plane.anchor + bow * plane.normal,
                          1 / (tie.looseness * plane.thickness),
                          (place - cameras_->poses[pose].center).norm());
    };
    for (const PlaneTie& tie : plane.points) {
      const PointTrackState& point = state_->points[tie.landmark];
      if (!point.IsLandmark()) continue;
      const int pose = pose_of(point);
      AddResiduals(
          std::make_unique<PointOnPlaneCost>(
              place_at(tie, point.position, pose)),
          loss, {PointBlock(tie.landmark), PlaneBlock(p), CenterBlock(pose)});
    }
    for (const PlaneTie& tie : plane.lines) {
      const LineTrackState& line = state_->lines[tie.landmark];
      if (!line.IsLandmark()) continue;
      const int pose = pose_of(line);
      AddResiduals(
          std::make_unique<LineOnPlaneCost>(
              place_at(tie, line.point + line.low * line.direction, pose),
              place_at(tie, line.point + line.high * line.direction, pose),
              line.low, line.high),
          loss, {LineBlock(tie.landmark), PlaneBlock(p), CenterBlock(pose)});
    }
  }
}

std::vector<int> ProblemBuilder::ComponentOfPoses() const {
  std::vector<int> component_of(cameras_->poses.size(), -1);
  for (std::size_t n = 0; n < components_.size(); ++n) {
    for (const int pose : components_[n].poses) {
      component_of[pose] = static_cast<int>(n);
    }
  }
  return component_of;
}

void ProblemBuilder::AddPriors() {
  // In standard deviations; a false measurement loses its hold.
  constexpr double kLossScale = 3;
  losses_.push_back(std::make_unique<ceres::CauchyLoss>(kLossScale));
  ceres::LossFunction* loss = losses_.back().get();
  const std::vector<int> component_of = ComponentOfPoses();
  // Whether one component holds all; the centre of a pose without structure is
  // none of the unknowns.
  const auto in_one = [&](std::initializer_list<int> poses) {
    const int component = component_of[*poses.begin()];
    return component >= 0 &&
           std::all_of(poses.begin(), poses.end(), [&](int pose) {
             return component_of[pose] == component;
           });
  };
  for (const RelativePosePrior& prior : state_->priors) {
    if (!in_one({prior.first, prior.second})) continue;
    AddResiduals(std::make_unique<RelativePoseCost>(prior.measured), loss,
                 {RotationBlock(prior.first), CenterBlock(prior.first),
                  RotationBlock(prior.second), CenterBlock(prior.second)});
  }
  for (const ScaleRatioPrior& prior : state_->ratio_priors) {
    if (!in_one({prior.first, prior.middle, prior.last})) continue;
    AddResiduals(std::make_unique<ScaleRatioCost>(prior.log_ratio,
                                                  prior.log_ratio_stddev),
                 loss,
                 {CenterBlock(prior.first), CenterBlock(prior.middle),
                  CenterBlock(prior.last)});
  }
}

void ProblemBuilder::AddDirections() {
  // Lines that are nearly parallel to a direction are none of its own.
  constexpr double kLossScale = 3;
  losses_.push_back(std::make_unique<ceres::CauchyLoss>(kLossScale));
  ceres::LossFunction* loss = losses_.back().get();
  const std::vector<int> component_of = ComponentOfPoses();
  for (std::size_t c = 0; c < components_.size(); ++c) {
    for (const int n : components_[c].directions) {
      for (const DirectionSight& sight : state_->directions[n].sights) {
        if (component_of[sight.pose] != static_cast<int>(c)) continue;
        AddResiduals(
            std::make_unique<DirectionCost>(sight.direction, sight.covariance),
            loss, {RotationBlock(sight.pose), DirectionBlock(n)});
      }
    }
  }
}

}  // namespace lowlap
