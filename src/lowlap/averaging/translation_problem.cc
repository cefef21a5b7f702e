#include "lowlap/averaging/translation_problem.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "lowlap/averaging/internal/track_rays.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

constexpr double kDefaultDirectionRad = 0.02;
constexpr double kWeakRatioFloor = 0.2;

}  // namespace

int TranslationSolution::NumPlaced() const {
  return static_cast<int>(std::count(component.begin(), component.end(), 0));
}

double DirectionStddev(const RelativePose& pose) {
  if (!pose.covariance) return kDefaultDirectionRad;
  const double variance =
      pose.covariance->bottomRightCorner<2, 2>().trace() / 2;
  return std::sqrt(std::max(variance, 0.0) +
                   kPoseErrorFloorRad * kPoseErrorFloorRad);
}

TranslationProblem MakeTranslationProblem(
    const Scene& scene, const std::map<ViewId, Mat3>& cam_from_world,
    const std::vector<ViewPair>& excluded_edges,
    const std::set<ViewTriplet>& weak, bool with_tracks) {
  TranslationProblem problem;
  std::map<ViewId, std::size_t> index_of_view;
  for (const auto& [view, rotation] : cam_from_world) {
    index_of_view[view] = problem.views.size();
    problem.views.push_back(view);
    problem.cam_from_world.push_back(rotation);
  }
  const std::set<ViewPair> excluded(excluded_edges.begin(),
                                    excluded_edges.end());
  std::map<ViewPair, std::size_t> index_of_edge;
  for (const auto& [views, pose] : scene.relative_poses) {
    const auto first = index_of_view.find(views.first);
    const auto second = index_of_view.find(views.second);
    if (first == index_of_view.end() || second == index_of_view.end() ||
        excluded.count(views) > 0) {
      continue;
    }
    DirectionEdge edge;
    edge.first = first->second;
    edge.second = second->second;
    // lambda t = R_2 (C_1 - C_2).
    edge.direction_in_world =
        -(problem.cam_from_world[edge.second].transpose() * pose.direction);
    edge.stddev_rad = DirectionStddev(pose);
    index_of_edge[views] = problem.edges.size();
    problem.edges.push_back(edge);
  }
  const auto find_edge = [&](ViewId a, ViewId b) {
    return index_of_edge.find({std::min(a, b), std::max(a, b)});
  };
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    const bool is_meaningful = ratio.verdict == RatioVerdict::kMeaningful;
    if (!is_meaningful && weak.count(ratio.views) == 0) continue;
    const auto reference = find_edge(ratio.views.first, ratio.views.middle);
    const auto target = find_edge(ratio.views.middle, ratio.views.last);
    if (reference == index_of_edge.end() || target == index_of_edge.end()) {
      continue;
    }
    RatioMeasurement measurement;
    measurement.views = ratio.views;
    measurement.reference = reference->second;
    measurement.target = target->second;
    measurement.log_ratio = ratio.log_ratio;
    measurement.stddev =
        std::hypot(ratio.log_ratio_stddev,
                   is_meaningful ? kRatioErrorFloor : kWeakRatioFloor);
    measurement.log10_nfa = ratio.log10_nfa;
    problem.ratios.push_back(measurement);
  }
  if (with_tracks) {
    problem.tracks = MakeTrackRays(scene, problem.views, problem.cam_from_world,
                                   excluded_edges);
  }
  return problem;
}

Status ValidateProblem(const TranslationProblem& problem) {
  const auto invalid = [](const std::string& message) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "translation problem: " + message);
  };
  if (problem.cam_from_world.size() != problem.views.size()) {
    return invalid("one rotation per view is needed");
  }
  for (const Mat3& rotation : problem.cam_from_world) {
    if (!rotation.allFinite()) return invalid("a rotation is not finite");
  }
  for (const DirectionEdge& edge : problem.edges) {
    if (edge.first >= problem.views.size() ||
        edge.second >= problem.views.size() || edge.first == edge.second) {
      return invalid("an edge does not join two views");
    }
    if (!(std::abs(edge.direction_in_world.norm() - 1) <= kUnitTolerance) ||
        !IsPositive(edge.stddev_rad)) {
      return invalid("an edge needs a unit direction and a deviation");
    }
  }
  for (const RatioMeasurement& ratio : problem.ratios) {
    if (ratio.reference >= problem.edges.size() ||
        ratio.target >= problem.edges.size() ||
        ratio.reference == ratio.target) {
      return invalid("a ratio does not join two edges");
    }
    if (!std::isfinite(ratio.log_ratio) || !IsPositive(ratio.stddev) ||
        !std::isfinite(ratio.log10_nfa)) {
      return invalid("a ratio needs a finite value, deviation and NFA");
    }
  }
  for (const TrackRays& track : problem.tracks) {
    for (const RayObservation& seen : track.observations) {
      if (seen.view >= problem.views.size() ||
          !(std::abs(seen.ray_in_world.norm() - 1) <= kUnitTolerance)) {
        return invalid("a track needs unit rays of its views");
      }
    }
  }
  return {};
}

}  // namespace lowlap
