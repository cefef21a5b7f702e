// Tutorial 5: lowlap as the global translation step inside OpenMVG.
//
// lowlap_global_engine.h is the whole engine; what differs from OpenMVG's own
// stands between its two marks. Here it solves a little world of six cameras
// before a scattered wall, under OpenMVG's rotations and under lowlap's. It is
// compiled against OpenMVG 2.1 if that is found (-DOpenMVG_DIR=...), built with
// the same Eigen and Ceres as lowlap, and otherwise against a stand-in that has
// the same names and types.
//
//   cmake -S tutorials/05_openmvg_engine -B build/tutorial05
//   cmake --build build/tutorial05 && build/tutorial05/openmvg_engine
#include <lowlap/geometry/similarity.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "lowlap_global_engine.h"
#include "openMVG/cameras/Camera_Pinhole.hpp"

namespace {

constexpr int kCameras = 6, kPoints = 300;
constexpr int kWidth = 1600, kHeight = 1200;
constexpr double kFocal = 900;

struct Project {
  openMVG::sfm::SfM_Data scene;
  openMVG::sfm::Features_Provider features;
  openMVG::sfm::Matches_Provider matches;
  std::vector<Eigen::Vector3d> true_centers;
};

// As OpenMVG's files would fill it: no poses, and no photographs on the disk.
void Fill(Project* project) {
  openMVG::sfm::SfM_Data& scene = project->scene;
  scene.intrinsics[0] = std::make_shared<openMVG::cameras::Pinhole_Intrinsic>(
      kWidth, kHeight, kFocal, kWidth / 2, kHeight / 2);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Eigen::Vector3d> points(kPoints);
  for (Eigen::Vector3d& point : points) {
    point << 1.5 * uniform(random), 1.5 * uniform(random), 7 + uniform(random);
  }
  for (int n = 0; n < kCameras; ++n) {
    const Eigen::Vector3d center(0.8 * n - 2, 0.1 * (n % 2), 0.2 * n);
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(0.08 * n - 0.2, Eigen::Vector3d::UnitY())
            .toRotationMatrix();
    project->true_centers.push_back(center);
    scene.views[n] = std::make_shared<openMVG::sfm::View>(
        std::to_string(n) + ".jpg", n, 0, n, kWidth, kHeight);
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector2d pixel =
          kFocal * (rotation * (point - center)).hnormalized() +
          Eigen::Vector2d(kWidth / 2, kHeight / 2);
      project->features.feats_per_view[n].emplace_back(pixel.x(), pixel.y());
    }
    for (int before = std::max(0, n - 2); before < n; ++before) {
      const openMVG::Pair pair(before, n);
      for (int i = 0; i < kPoints; ++i) {
        project->matches.pairWise_matches_[pair].emplace_back(i, i);
      }
    }
  }
}

// Whether every camera is placed, and where it truly is.
bool Solve(LowlapGlobalEngine::Rotations rotations, const char* whose) {
  Project project;
  Fill(&project);
  LowlapGlobalEngine engine(project.scene, "");
  engine.SetFeaturesProvider(&project.features);
  engine.SetMatchesProvider(&project.matches);
  engine.SetRotations(rotations);
  if (!engine.Process()) return false;

  std::vector<Eigen::Vector3d> solved, truth;
  for (const auto& [id, pose] : engine.Get_SfM_Data().GetPoses()) {
    solved.push_back(pose.center());
    truth.push_back(project.true_centers[id]);
  }
  const auto aligned = lowlap::AlignPoints(solved, truth);
  if (!aligned) return false;
  double worst = 0;
  for (std::size_t n = 0; n < solved.size(); ++n) {
    worst = std::max(worst, (*aligned * solved[n] - truth[n]).norm());
  }
  std::printf("%s rotations: %zu of %d cameras, worst error %.2g\n", whose,
              solved.size(), kCameras, worst);
  return solved.size() == kCameras && worst < 1e-3;
}

}  // namespace

int main() {
  const bool host = Solve(LowlapGlobalEngine::Rotations::kHost, "OpenMVG's");
  const bool own = Solve(LowlapGlobalEngine::Rotations::kLowlap, "lowlap's");
  return host && own ? 0 : 1;
}
