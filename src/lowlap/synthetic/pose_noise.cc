#include "lowlap/synthetic/internal/pose_noise.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <map>
#include <optional>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using Mat5 = Eigen::Matrix<double, 5, 5>;
using Vec5 = Eigen::Matrix<double, 5, 1>;

constexpr std::uint64_t kNoiseStream = 7'000'000'000;
constexpr std::uint64_t kDirectionStream = 8'000'000'000;
constexpr std::uint64_t kWrongPoseStream = 10'000'000'000;
constexpr double kPriorRad = 0.3;

std::uint64_t PoseStream(std::uint64_t base, const ViewPair& pair) {
  return base + pair.first.value() * 1'000'003ull + pair.second.value();
}

Vec3 DrawDirection(Random* random) {
  Vec3 direction;
  for (double& component : direction) component = random->Gaussian();
  return direction.normalized();
}

// The information of one point about the pair's pose, in (noise / focal)^-2.
Mat5 Information(const RigidTransform& cam2_from_cam1, const Vec3& in_first) {
  const Mat3& rotation = cam2_from_cam1.rotation;
  const Vec3 t = cam2_from_cam1.translation.normalized();
  const Vec3 x1 = in_first / in_first.z();
  const Vec3 in_second = cam2_from_cam1 * in_first;
  const Vec3 x2 = in_second / in_second.z();
  const Vec3 y = rotation * x1;
  Vec5 slope;
  slope << y.cross(x2.cross(t)), TangentBasis(t).transpose() * y.cross(x2);
  const Vec3 by_x2 = t.cross(y);
  const Vec3 by_x1 = rotation.transpose() * x2.cross(t);
  const double variance =
      by_x1.head<2>().squaredNorm() + by_x2.head<2>().squaredNorm();
  if (!(variance > 0)) return Mat5::Zero();
  return slope * slope.transpose() / variance;
}

}  // namespace

void AddPoseNoiseOfPoints(const SyntheticOptions& options,
                          SyntheticScene* synthetic) {
  Scene& scene = synthetic->scene;
  std::map<ViewPair, RigidTransform> motions;
  std::map<ViewPair, Mat5> information;
  for (const auto& entry : scene.relative_poses) {
    const ViewPair& pair = entry.first;
    RigidTransform motion =
        synthetic->true_poses.at(pair.second).CamFromWorld() *
        synthetic->true_poses.at(pair.first).CamFromWorld().Inverse();
    if (!(synthetic->true_baselines.at(pair) > 0)) {
      // Any direction explains the matches as well.
      motion.translation.setZero();
    }
    motions[pair] = motion;
    information[pair] = Mat5::Zero();
  }
  const double noise = options.noise_px / options.focal_px;
  for (const auto& [id, track] : scene.point_tracks) {
    const auto point = synthetic->true_points.find(id);
    if (point == synthetic->true_points.end()) continue;
    for (std::size_t a = 0; a < track.size(); ++a) {
      for (std::size_t b = 0; b < track.size(); ++b) {
        const ViewPair pair = {track[a].view, track[b].view};
        const auto motion = motions.find(pair);
        if (motion == motions.end() || motion->second.translation.isZero(0)) {
          continue;
        }
        const Vec3 in_first =
            synthetic->true_poses.at(pair.first).CamFromWorld() * point->second;
        information[pair] += Information(motion->second, in_first);
      }
    }
  }
  for (auto& [pair, edge] : scene.relative_poses) {
    const Mat5 total =
        information[pair] + Mat5::Identity() * std::pow(noise / kPriorRad, 2);
    const Mat5 covariance = std::pow(options.pose_noise_factor * noise, 2) *
                            total.llt().solve(Mat5::Identity());
    Random random(options.seed, PoseStream(kNoiseStream, pair));
    Vec5 draw;
    for (double& component : draw) component = random.Gaussian();
    const Vec5 error = covariance.llt().matrixL() * draw;
    if (!error.allFinite()) continue;  // no noise at all
    const Vec3 turn = error.head<3>();
    const Vec2 tilt = error.tail<2>();
    edge.rotation =
        NearestRotation(RotationFromAngleAxis(turn) * edge.rotation);
    edge.direction =
        (edge.direction + TangentBasis(edge.direction) * tilt).normalized();
    edge.covariance = covariance + edge.covariance.value_or(Mat5(Mat5::Zero()));
  }
}

void DrawWrongDirections(const SyntheticOptions& options, Scene* scene) {
  for (auto& [pair, edge] : scene->relative_poses) {
    Random random(options.seed, PoseStream(kDirectionStream, pair));
    if (random.Uniform() >= options.wrong_direction_share) continue;
    edge.direction = DrawDirection(&random);
  }
}

void DrawWrongPoses(const SyntheticOptions& options, Scene* scene) {
  for (auto& [pair, edge] : scene->relative_poses) {
    Random random(options.seed, PoseStream(kWrongPoseStream, pair));
    if (random.Uniform() >= options.wrong_pose_share) continue;
    const double angle = random.Uniform(0, kPi);
    edge.rotation = RotationFromAngleAxis(angle * DrawDirection(&random));
    edge.direction = DrawDirection(&random);
  }
}

}  // namespace lowlap
