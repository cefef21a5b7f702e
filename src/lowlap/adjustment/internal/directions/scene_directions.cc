#include "lowlap/adjustment/internal/directions/scene_directions.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/directions/internal/vanishing_directions.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/scene/internal/pixel_unit.h"

namespace lowlap {
namespace {

constexpr double kPoseStddevDeg = 0.5;
constexpr double kReach = 3;

Vec3 InWorld(const DirectionSight& sight, const CameraSet& cameras) {
  return cameras.poses[sight.pose].cam_from_world.conjugate() * sight.direction;
}

// In standard deviations, with that of the rotation added; of either sign.
double Deviation(const DirectionSight& sight, const Vec3& in_world,
                 double pose_stddev_rad, const CameraSet& cameras) {
  const Vec3 in_camera = cameras.poses[sight.pose].cam_from_world * in_world;
  // Beyond 45 degrees the tangent plane says less and less.
  if (std::abs(in_camera.dot(sight.direction)) < std::sqrt(0.5)) {
    return kInfinity;
  }
  const auto basis = TangentBasis(sight.direction);
  const Mat2 covariance = basis.transpose() * sight.covariance * basis +
                          pose_stddev_rad * pose_stddev_rad * Mat2::Identity();
  const Vec2 error = basis.transpose() * in_camera;
  return std::sqrt(error.dot(covariance.inverse() * error));
}

// The free sights that agree with a direction, which becomes their mean.
std::vector<std::size_t> Gather(const std::vector<DirectionSight>& sights,
                                const std::vector<char>& is_free,
                                const CameraSet& cameras, Vec3* direction) {
  const double pose_stddev_rad = RadFromDeg(kPoseStddevDeg);
  std::vector<std::size_t> members;
  Vec3 sum = Vec3::Zero();
  std::set<int> poses;
  for (std::size_t n = 0; n < sights.size(); ++n) {
    if (!is_free[n] ||
        Deviation(sights[n], *direction, pose_stddev_rad, cameras) > kReach ||
        !poses.insert(sights[n].pose).second) {
      continue;
    }
    members.push_back(n);
    const Vec3 in_world = InWorld(sights[n], cameras);
    const double sign = in_world.dot(*direction) < 0 ? -1 : 1;
    sum += sign / sights[n].covariance.trace() * in_world;
  }
  if (!members.empty()) *direction = sum.normalized();
  return members;
}

void ScaleCovariances(const CameraSet& cameras,
                      std::vector<SceneDirection>* directions) {
  std::vector<double> deviations;
  for (const SceneDirection& direction : *directions) {
    for (const DirectionSight& sight : direction.sights) {
      deviations.push_back(Deviation(sight, direction.direction, 0, cameras));
    }
  }
  if (deviations.empty()) return;
  const double scale =
      std::max(1.0, Median(std::move(deviations)) / kMedianOfNorm<2>);
  for (SceneDirection& direction : *directions) {
    for (DirectionSight& sight : direction.sights) {
      sight.covariance *= scale * scale;
    }
  }
}

}  // namespace

Result<std::vector<DirectionSight>> FindDirectionSights(
    const Scene& scene, const CameraSet& cameras, const RunContext& context) {
  std::vector<std::vector<DirectionSight>> of_view(cameras.views.size());
  const Status done = ParallelFor(
      context, "directions", cameras.views.size(), [&](std::size_t n) {
        const CameraView& view = cameras.views[n];
        const auto features = scene.features.find(view.id);
        if (features == scene.features.end()) return;
        const VanishingOptions options;
        const double stddev = RadFromDeg(options.parallel_stddev_deg);
        const Intrinsic& intrinsic = cameras.intrinsics[view.intrinsic].value;
        for (const VanishingDirection& found : FindVanishingDirections(
                 NormalizeFeatures(features->second, intrinsic), options,
                 PixelUnit(intrinsic.ImageDiagonal()))) {
          of_view[n].push_back({view.pose, found.direction,
                                WidenedCovariance(found, stddev),
                                found.log10_nfa});
        }
      });
  if (!done) return tl::unexpected<Error>(done.error());
  std::vector<DirectionSight> sights;
  for (const auto& of_one : of_view) {
    sights.insert(sights.end(), of_one.begin(), of_one.end());
  }
  std::stable_sort(sights.begin(), sights.end(),
                   [](const DirectionSight& a, const DirectionSight& b) {
                     return a.log10_nfa < b.log10_nfa;
                   });
  return sights;
}

std::vector<SceneDirection> GroupDirections(
    const std::vector<DirectionSight>& sights, const CameraSet& cameras) {
  std::vector<SceneDirection> directions;
  std::vector<char> is_free(sights.size(), 1);
  for (std::size_t n = 0; n < sights.size(); ++n) {
    if (!is_free[n]) continue;
    SceneDirection direction;
    direction.direction = InWorld(sights[n], cameras);
    std::vector<std::size_t> members;
    for (int round = 0; round < 3; ++round) {
      members = Gather(sights, is_free, cameras, &direction.direction);
    }
    is_free[n] = 0;
    if (members.size() < 2) continue;
    for (const std::size_t member : members) {
      is_free[member] = 0;
      direction.sights.push_back(sights[member]);
    }
    directions.push_back(std::move(direction));
  }
  ScaleCovariances(cameras, &directions);
  return directions;
}

}  // namespace lowlap
