#pragma once

#include <map>
#include <string>
#include <vector>

#include "averaging/true_ratios.h"
#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// Eight views, of whose relative poses and ratios none is in doubt.
inline SyntheticScene WellMeasuredScene(const std::string& pairs) {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = pairs;
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    ratio.kinds = {{"lines", 20, 20}};
  }
  for (auto& entry : synthetic.scene.relative_poses) {
    entry.second.log10_nfa = -100;
  }
  return synthetic;
}

/// nullptr if there is none.
inline ScaleRatio* FindRatio(const ViewTriplet& views, Scene* scene) {
  for (ScaleRatio& ratio : scene->scale_ratios) {
    if (ratio.views == views) return &ratio;
  }
  return nullptr;
}

/// Relative poses that fit anything.
inline void MakeVague(const std::vector<ViewPair>& pairs, Scene* scene) {
  using Mat5 = Eigen::Matrix<double, 5, 5>;
  Mat5 covariance = 1e-8 * Mat5::Identity();
  covariance.topLeftCorner<3, 3>() = 0.3 * Mat3::Identity();
  for (const ViewPair& views : pairs) {
    scene->relative_poses.at(views).covariance = covariance;
  }
}

/// Directions to a milliradian.
inline void StatePreciseDirections(Scene* scene) {
  for (auto& entry : scene->relative_poses) {
    entry.second.covariance = 1e-6 * Eigen::Matrix<double, 5, 5>::Identity();
  }
}

inline std::map<ViewId, Mat3> TrueRotations(const SyntheticScene& synthetic) {
  std::map<ViewId, Mat3> rotations;
  for (const auto& [view, pose] : synthetic.true_poses) {
    rotations[view] = pose.rotation;
  }
  return rotations;
}

inline TranslationSolution TrueCenters(const SyntheticScene& synthetic) {
  TranslationSolution solution;
  for (const auto& entry : synthetic.true_poses) {
    solution.center_in_world.push_back(entry.second.center);
    solution.component.push_back(0);
  }
  solution.num_components = 1;
  return solution;
}

}  // namespace lowlap
