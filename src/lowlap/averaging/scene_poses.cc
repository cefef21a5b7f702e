#include "lowlap/averaging/scene_poses.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "lowlap/averaging/strategies.h"
#include "lowlap/averaging/union_find.h"
#include "lowlap/core/median.h"
#include "lowlap/geometry/rotation.h"

namespace lowlap {
namespace {

constexpr double kRotationFloorRad = 5e-4;
constexpr double kDefaultRotationRad = 5e-3;

double RotationStddev(const RelativePose& pose) {
  if (!pose.covariance) return kDefaultRotationRad;
  const double variance = pose.covariance->topLeftCorner<3, 3>().trace() / 3;
  return std::sqrt(std::max(variance, 0.0) +
                   kRotationFloorRad * kRotationFloorRad);
}

struct AveragedRotations {
  std::map<ViewId, Mat3> cam_from_world;
  std::vector<ViewPair> outlier_edges;
  double median_residual_rad = 0;
};

// The views of the largest connected component of the given edges.
std::set<ViewId> LargestComponent(const std::vector<ViewPair>& edges) {
  std::map<ViewId, std::size_t> index;
  for (const ViewPair& edge : edges) {
    index.emplace(edge.first, index.size());
    index.emplace(edge.second, index.size());
  }
  UnionFind sets(index.size());
  for (const ViewPair& edge : edges) {
    sets.Union(index.at(edge.first), index.at(edge.second));
  }
  const std::vector<std::size_t> labels = sets.Labels();
  std::map<std::size_t, std::set<ViewId>> components;
  for (const auto& [view, n] : index) components[labels[n]].insert(view);
  std::set<ViewId> largest;
  for (auto& entry : components) {
    if (entry.second.size() > largest.size()) largest = std::move(entry.second);
  }
  return largest;
}

Result<AveragedRotations> AverageSceneRotations(const Scene& scene,
                                                const PoseOptions& options) {
  std::vector<ViewPair> edges;
  for (const auto& entry : scene.relative_poses) edges.push_back(entry.first);
  AveragedRotations averaged;
  // Leaving outliers out may take a view with it, so average again after it.
  for (bool changed = true; changed;) {
    changed = false;
    const std::set<ViewId> component = LargestComponent(edges);
    std::vector<ViewId> views(component.begin(), component.end());
    std::map<ViewId, std::size_t> index;
    for (const ViewId view : views) index.emplace(view, index.size());
    std::vector<RotationMeasurement> measurements;
    std::vector<ViewPair> used;
    for (const ViewPair& edge : edges) {
      if (component.count(edge.first) == 0) continue;
      const RelativePose& pose = scene.relative_poses.at(edge);
      RotationMeasurement m;
      m.first = index.at(edge.first);
      m.second = index.at(edge.second);
      m.second_from_first = pose.rotation;
      m.stddev_rad = RotationStddev(pose);
      m.cost = pose.log10_nfa;
      measurements.push_back(m);
      used.push_back(edge);
    }
    const auto result =
        AverageRotations(views.size(), measurements, options.rotation);
    if (!result) return tl::unexpected<Error>(result.error());
    averaged.cam_from_world.clear();
    for (std::size_t n = 0; n < views.size(); ++n) {
      averaged.cam_from_world[views[n]] = result->cam_from_world[n];
    }
    if (measurements.empty()) return averaged;

    averaged.median_residual_rad = Median(result->residuals_rad);
    // The median of the norm of a 3-vector of normal errors is 1.54 sigma.
    const double sigma =
        std::max(averaged.median_residual_rad / 1.54, kRotationFloorRad);
    std::vector<ViewPair> kept;
    for (std::size_t e = 0; e < used.size(); ++e) {
      const double own = std::max(sigma, measurements[e].stddev_rad);
      if (result->residuals_rad[e] > options.outlier_reach * own) {
        averaged.outlier_edges.push_back(used[e]);
        changed = true;
      } else {
        kept.push_back(used[e]);
      }
    }
    edges = std::move(kept);
  }
  std::sort(averaged.outlier_edges.begin(), averaged.outlier_edges.end());
  return averaged;
}

// First placed view: identity at the origin; mean placed edge: length 1.
void FixGauge(const TranslationProblem& problem,
              const TranslationSolution& solution, Scene* scene) {
  double total = 0;
  int count = 0;
  for (const DirectionEdge& edge : problem.edges) {
    if (solution.component[edge.first] != 0 ||
        solution.component[edge.second] != 0) {
      continue;
    }
    total += (solution.center_in_world[edge.second] -
              solution.center_in_world[edge.first])
                 .norm();
    ++count;
  }
  const double scale = total > 0 ? count / total : 1.0;
  scene->poses.clear();
  bool first = true;
  Mat3 old_world_from_world = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution.component[n] != 0) continue;
    if (first) {
      old_world_from_world = problem.cam_from_world[n].transpose();
      origin = solution.center_in_world[n];
      first = false;
    }
    Pose pose;
    pose.rotation =
        NearestRotation(problem.cam_from_world[n] * old_world_from_world);
    pose.center = scale * (old_world_from_world.transpose() *
                           (solution.center_in_world[n] - origin));
    scene->poses[scene->views.at(problem.views[n]).pose_id] = pose;
  }
}

}  // namespace

Status PoseOptions::Validate() const {
  if (!(outlier_reach > 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "poses: the outlier reach must be positive");
  }
  return rotation.Validate();
}

Result<PoseSummary> SolveScenePoses(Scene* scene, const PoseOptions& options,
                                    const RunContext& context) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  const auto averager = MakeTranslationAverager(options.strategy);
  if (!averager) return tl::unexpected<Error>(averager.error());
  if (scene->relative_poses.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     "the scene has no relative pose to build on");
  }
  const auto rotations = AverageSceneRotations(*scene, options);
  if (!rotations) return tl::unexpected<Error>(rotations.error());
  if (rotations->cam_from_world.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     "no two relative rotations agree");
  }
  const TranslationProblem problem = MakeTranslationProblem(
      *scene, rotations->cam_from_world, rotations->outlier_edges);
  const auto solution = (*averager)->Solve(problem, context);
  if (!solution) return tl::unexpected<Error>(solution.error());

  FixGauge(problem, *solution, scene);
  PoseSummary summary;
  summary.num_views = static_cast<int>(scene->views.size());
  summary.components.resize(static_cast<std::size_t>(solution->num_components));
  std::set<ViewId> placed;
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution->component[n] < 0) continue;
    summary.components[solution->component[n]].push_back(problem.views[n]);
    if (solution->component[n] == 0) placed.insert(problem.views[n]);
  }
  for (const auto& entry : scene->views) {
    if (placed.count(entry.first) == 0) summary.unplaced.push_back(entry.first);
  }
  summary.num_placed = static_cast<int>(placed.size());
  summary.outlier_edges = rotations->outlier_edges;
  summary.num_edges = static_cast<int>(problem.edges.size());
  summary.num_ratios = static_cast<int>(problem.ratios.size());
  summary.median_rotation_residual_deg =
      DegFromRad(rotations->median_residual_rad);
  return summary;
}

}  // namespace lowlap
