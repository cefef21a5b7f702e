#include "lowlap/adjustment/internal/rounds/problem_selection.h"

#include <algorithm>
#include <map>
#include <set>

#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

template <class Track>
int FirstPose(const CameraSet& cameras, const Track& track) {
  for (const auto& candidate : track.candidates) {
    if (candidate.used) return cameras.views[candidate.view].pose;
  }
  return -1;
}

// By the similarity  x -> place(x),  whose rotation is `turn` and whose scale
// is `scale`.
template <class Place>
void MoveComponent(const Component& component, const Eigen::Quaterniond& turn,
                   double scale, const Place& place, CameraSet* cameras,
                   StructureState* state) {
  for (const int n : component.poses) {
    PoseState& pose = cameras->poses[n];
    pose.cam_from_world = (pose.cam_from_world * turn.conjugate()).normalized();
    pose.center = place(pose.center);
  }
  for (const int n : component.points) {
    state->points[n].position = place(state->points[n].position);
  }
  for (const int n : component.lines) {
    LineTrackState& line = state->lines[n];
    line.point = place(line.point);
    line.direction = (turn * line.direction).normalized();
    line.low *= scale;
    line.high *= scale;
  }
  for (const int n : component.planes) {
    PlaneState& plane = state->planes[n];
    plane.normal = (turn * plane.normal).normalized();
    plane.anchor = place(plane.anchor);
    plane.offset *= scale;
    plane.bend =
        turn.toRotationMatrix() * plane.bend * turn.conjugate() / scale;
    plane.thickness *= scale;
  }
  for (const int n : component.directions) {
    Vec3& direction = state->directions[n].direction;
    direction = (turn * direction).normalized();
  }
}

// Calls visit(pose) with the first pose of every landmark on the plane.
template <class Visit>
void VisitPosesOf(const CameraSet& cameras, const StructureState& state,
                  const PlaneState& plane, const Visit& visit) {
  const auto visit_all = [&](const auto& ties, const auto& tracks) {
    for (const PlaneTie& tie : ties) {
      const auto& track = tracks[tie.landmark];
      if (track.IsLandmark()) visit(FirstPose(cameras, track));
    }
  };
  visit_all(plane.points, state.points);
  visit_all(plane.lines, state.lines);
}

}  // namespace

std::vector<int> ViewsOf(const LineTrackState& line) {
  std::set<int> views;
  for (const LineCandidate& candidate : line.candidates) {
    if (candidate.used) views.insert(candidate.view);
  }
  return {views.begin(), views.end()};
}

ProblemSelection SelectForSolve(const CameraSet& cameras,
                                const StructureState& state,
                                const AdjustmentOptions& options) {
  ProblemSelection selection;
  selection.pair_degree.assign(state.lines.size(), 0);
  if (options.use_points) {
    for (std::size_t n = 0; n < state.points.size(); ++n) {
      if (state.points[n].IsLandmark()) {
        selection.points.push_back(static_cast<int>(n));
      }
    }
  }
  if (!options.use_lines) return selection;
  if (options.use_coplanar) {
    for (std::size_t n = 0; n < state.pairs.size(); ++n) {
      const PairState& pair = state.pairs[n];
      if (!pair.used || !state.HasLines(pair)) continue;
      selection.pairs.push_back(static_cast<int>(n));
      ++selection.pair_degree[pair.first];
      ++selection.pair_degree[pair.second];
    }
  }
  std::vector<char> on_plane(state.lines.size(), 0);
  for (std::size_t n = 0; n < state.planes.size(); ++n) {
    selection.planes.push_back(static_cast<int>(n));
    for (const PlaneTie& tie : state.planes[n].lines)
      on_plane[tie.landmark] = 1;
  }
  for (std::size_t n = 0; n < state.lines.size(); ++n) {
    const LineTrackState& line = state.lines[n];
    if (line.IsLandmark() &&
        (selection.pair_degree[n] > 0 || on_plane[n] != 0 ||
         line.PoseCount(cameras) > 2)) {
      selection.lines.push_back(static_cast<int>(n));
    }
  }
  return selection;
}

std::vector<Component> FindComponents(const CameraSet& cameras,
                                      const StructureState& state,
                                      const ProblemSelection& selection) {
  UnionFind sets(cameras.poses.size());
  const auto find = [&](int pose) {
    return sets.Find(static_cast<std::size_t>(pose));
  };
  const auto unite = [&](int a, int b) {
    sets.Union(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
  };
  std::vector<char> observed(cameras.poses.size(), 0);
  std::vector<std::size_t> candidates(cameras.poses.size(), 0);
  const auto join = [&](const auto& track) {
    const int first = FirstPose(cameras, track);
    for (const auto& candidate : track.candidates) {
      const int pose = cameras.views[candidate.view].pose;
      ++candidates[pose];
      if (!candidate.used) continue;
      observed[pose] = 1;
      unite(first, pose);
    }
  };
  for (const int n : selection.points) join(state.points[n]);
  for (const int n : selection.lines) join(state.lines[n]);
  for (const int n : selection.pairs) {
    unite(FirstPose(cameras, state.lines[state.pairs[n].first]),
          FirstPose(cameras, state.lines[state.pairs[n].second]));
  }

  std::map<int, int> pose_of_plane;
  for (const int n : selection.planes) {
    VisitPosesOf(cameras, state, state.planes[n], [&](int pose) {
      unite(pose_of_plane.emplace(n, pose).first->second, pose);
    });
  }

  std::map<std::size_t, Component> by_root;  // then ordered by their first pose
  std::vector<std::size_t> roots;
  for (std::size_t n = 0; n < cameras.poses.size(); ++n) {
    if (!observed[n]) continue;
    const int pose = static_cast<int>(n);
    const std::size_t root = find(pose);
    Component& component = by_root[root];
    if (component.poses.empty()) roots.push_back(root);
    component.poses.push_back(pose);
    if (component.reference < 0 ||
        candidates[pose] > candidates[component.reference]) {
      component.reference = pose;
    }
  }
  for (const int n : selection.points) {
    by_root.at(find(FirstPose(cameras, state.points[n]))).points.push_back(n);
  }
  for (const int n : selection.lines) {
    by_root.at(find(FirstPose(cameras, state.lines[n]))).lines.push_back(n);
  }
  for (const auto& [plane, pose] : pose_of_plane) {
    by_root.at(find(pose)).planes.push_back(plane);
  }
  for (std::size_t n = 0; n < state.directions.size(); ++n) {
    std::map<std::size_t, int> num_sights;
    for (const DirectionSight& sight : state.directions[n].sights) {
      if (observed[sight.pose]) ++num_sights[find(sight.pose)];
    }
    const auto most = std::max_element(
        num_sights.begin(), num_sights.end(),
        [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most != num_sights.end() && most->second >= 2) {
      by_root.at(most->first).directions.push_back(static_cast<int>(n));
    }
  }
  std::vector<Component> components;
  for (const std::size_t root : roots) {
    Component& component = by_root.at(root);
    const Vec3& origin = cameras.poses[component.reference].center;
    for (const int pose : component.poses) {
      const double distance = (cameras.poses[pose].center - origin).norm();
      if (distance > component.baseline) {
        component.baseline = distance;
        component.partner = pose;
      }
    }
    components.push_back(std::move(component));
  }
  return components;
}

std::vector<PoseState> EnterComponentFrames(
    const std::vector<Component>& components, CameraSet* cameras,
    StructureState* state) {
  std::vector<PoseState> references;
  for (const Component& component : components) {
    references.push_back(cameras->poses[component.reference]);
    const PoseState& reference = references.back();
    const Eigen::Quaterniond& turn = reference.cam_from_world;
    MoveComponent(
        component, turn, 1 / component.Unit(),
        [&](const Vec3& x) -> Vec3 {
          return turn * (x - reference.center) / component.Unit();
        },
        cameras, state);
  }
  return references;
}

void LeaveComponentFrames(const std::vector<Component>& components,
                          const std::vector<PoseState>& references,
                          CameraSet* cameras, StructureState* state) {
  for (std::size_t n = 0; n < components.size(); ++n) {
    const Component& component = components[n];
    const PoseState& reference = references[n];
    const Eigen::Quaterniond turn = reference.cam_from_world.conjugate();
    MoveComponent(
        component, turn, component.Unit(),
        [&](const Vec3& y) -> Vec3 {
          return component.Unit() * (turn * y) + reference.center;
        },
        cameras, state);
    cameras->poses[component.reference] = reference;
  }
}

}  // namespace lowlap
