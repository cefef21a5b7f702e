#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/internal/coplanar_truth.h"
#include "lowlap/synthetic/internal/observe.h"
#include "lowlap/synthetic/internal/pair_graph.h"
#include "lowlap/synthetic/internal/pose_evidence.h"
#include "lowlap/synthetic/internal/pose_noise.h"
#include "lowlap/synthetic/internal/visibility.h"
#include "lowlap/synthetic/internal/world.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

constexpr std::uint64_t kPoseStream = 6'000'000'000;

void AddViews(const SyntheticOptions& options, const World& world,
              const Intrinsic& intrinsic, SyntheticScene* synthetic) {
  Scene& scene = synthetic->scene;
  scene.intrinsics[0] = intrinsic;
  for (ViewId id = 0; id < world.poses.size(); ++id) {
    View view;
    view.filename = Format("%06u.png", id.value());
    view.width_px = options.width_px;
    view.height_px = options.height_px;
    view.intrinsic_id = 0;
    view.pose_id = id.value();
    scene.views[id] = view;
    scene.features[id];  // a view may see nothing
    synthetic->true_poses[id] = world.poses[id.value()];
  }
}

// The true pose of the pair, turned by the pose noise.
RelativePose MakeRelativePose(const SyntheticOptions& options,
                              const ViewPair& pair,
                              const RigidTransform& cam2_from_cam1,
                              Random* random) {
  RelativePose edge;
  edge.views = pair;
  edge.rotation = cam2_from_cam1.rotation;
  if (cam2_from_cam1.translation.squaredNorm() > 0) {
    edge.direction = cam2_from_cam1.translation.normalized();
  }
  const double rotation_rad = RadFromDeg(options.rotation_noise_deg);
  const double direction_rad = RadFromDeg(options.direction_noise_deg);
  Vec3 turn;
  for (double& component : turn) component = random->Gaussian(rotation_rad);
  Vec2 tilt;
  for (double& component : tilt) component = random->Gaussian(direction_rad);
  if (rotation_rad > 0) {
    edge.rotation =
        NearestRotation(RotationFromAngleAxis(turn) * edge.rotation);
  }
  if (direction_rad > 0) {
    edge.direction =
        (edge.direction + TangentBasis(edge.direction) * tilt).normalized();
  }
  if (rotation_rad > 0 && direction_rad > 0) {
    Eigen::Matrix<double, 5, 1> variance;
    variance << Vec3::Constant(rotation_rad * rotation_rad),
        Vec2::Constant(direction_rad * direction_rad);
    edge.covariance = variance.asDiagonal();
  }
  edge.point_threshold_px = 3 * options.noise_px;
  return edge;
}

void AddRelativePoses(const SyntheticOptions& options,
                      const std::vector<Camera>& cameras,
                      const PairGraph& graph, SyntheticScene* synthetic) {
  for (const ViewPair& pair : graph.Pairs()) {
    const RigidTransform cam2_from_cam1 =
        cameras[pair.second.value()].cam_from_world *
        cameras[pair.first.value()].cam_from_world.Inverse();
    const Vec3 baseline = synthetic->true_poses.at(pair.second).center -
                          synthetic->true_poses.at(pair.first).center;
    synthetic->true_baselines[pair] = baseline.norm();
    Random random(
        options.seed,
        kPoseStream + pair.first.value() * 1'000'003ull + pair.second.value());
    RigidTransform exact = cam2_from_cam1;
    if (baseline.isZero(0)) exact.translation.setZero();
    synthetic->scene.relative_poses[pair] =
        MakeRelativePose(options, pair, exact, &random);
  }
}

void DropUnmatchedPairs(SyntheticScene* synthetic) {
  auto& edges = synthetic->scene.relative_poses;
  for (auto it = edges.begin(); it != edges.end();) {
    const RelativePose& edge = it->second;
    if (edge.point_inliers.empty() && edge.line_inliers.empty()) {
      synthetic->true_baselines.erase(it->first);
      it = edges.erase(it);
    } else {
      ++it;
    }
  }
}

std::map<ViewPair, int> CountSeenTogether(
    const std::vector<std::vector<ViewId>>& views_of_points,
    const std::vector<std::vector<ViewId>>& views_of_lines) {
  std::map<ViewPair, int> seen;
  for (const auto* kind : {&views_of_points, &views_of_lines}) {
    for (const std::vector<ViewId>& views : *kind) {
      for (std::size_t i = 0; i < views.size(); ++i) {
        for (std::size_t j = i + 1; j < views.size(); ++j) {
          ++seen[{views[i], views[j]}];
        }
      }
    }
  }
  return seen;
}

SyntheticScene Build(const SyntheticOptions& options, double off_wall) {
  World world = BuildLayout(options);
  FillWalls(options, off_wall, &world);
  if (options.alike_share > 0) MakeWallsAlike(options.alike_share, &world);
  const std::vector<Camera> cameras = BuildCameras(options, world);
  const auto views_of_points = ViewsOfPoints(world, cameras);
  const auto views_of_lines = ViewsOfLines(world, cameras);

  const PairRule rule = *PairRule::Parse(options.pairs);
  const PairGraph graph(rule, options.num_views,
                        rule.all
                            ? CountSeenTogether(views_of_points, views_of_lines)
                            : std::map<ViewPair, int>());

  SyntheticScene synthetic;
  synthetic.planes = world.planes;
  AddViews(options, world, cameras.front().intrinsic, &synthetic);
  AddRelativePoses(options, cameras, graph, &synthetic);
  ObservePoints(options, world, cameras, graph, views_of_points, &synthetic);
  ObserveLines(options, world, cameras, graph, views_of_lines, &synthetic);
  const bool only_poses =
      options.points_per_wall == 0 && options.lines_per_wall == 0;
  if (!only_poses) DropUnmatchedPairs(&synthetic);
  if (options.pose_noise_factor > 0) {
    AddPoseNoiseOfPoints(options, &synthetic);
  }
  // Before any is made wrong: those claim as much as the right ones.
  StatePointEvidence(&synthetic.scene);
  if (options.wrong_direction_share > 0) {
    DrawWrongDirections(options, &synthetic.scene);
  }
  if (options.wrong_pose_share > 0) {
    DrawWrongPoses(options, &synthetic.scene);
  }
  return synthetic;
}

}  // namespace

Result<SyntheticScene> Simulate(const SyntheticOptions& options) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  SyntheticScene best = Build(options, 0.0);
  const double wanted = options.wrong_candidate_share;
  if (wanted <= 0) return best;
  double best_share = CountCoplanarCandidates(best).WrongShare();
  if (best_share >= wanted) return best;
  // The share grows with the lines moved off: bisection on how many.
  constexpr int kMaxSteps = 10;
  constexpr double kCloseEnough = 0.005;
  double low = 0.0, high = 1.0;
  for (int step = 0;
       step < kMaxSteps && std::abs(best_share - wanted) > kCloseEnough;
       ++step) {
    const double off_wall = 0.5 * (low + high);
    SyntheticScene scene = Build(options, off_wall);
    const double share = CountCoplanarCandidates(scene).WrongShare();
    (share < wanted ? low : high) = off_wall;
    if (std::abs(share - wanted) < std::abs(best_share - wanted)) {
      best_share = share;
      best = std::move(scene);
    }
  }
  return best;
}

}  // namespace lowlap
