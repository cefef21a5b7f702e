#pragma once

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "lowlap_global_engine.h"
#include "openMVG/cameras/Camera_Pinhole.hpp"
#include "third_party_adapters/openmvg/internal/matches.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {

/// What OpenMVG's program holds before its translation step.
struct Host {
  openMVG::sfm::SfM_Data scene;
  openMVG::sfm::Features_Provider features;
  openMVG::sfm::Matches_Provider matches;
};

/// Loads a project of pinhole cameras as OpenMVG does: feature positions in
/// single precision, no pair of a view that the listing does not have.
inline Result<Host> LoadHost(const std::string& listing,
                             const std::string& matches_folder,
                             const std::string& match_file) {
  const Result<Scene> scene = ReadScene(listing);
  if (!scene) return tl::unexpected<Error>(scene.error());
  Host host;
  host.scene.s_root_path = scene->root_path;
  for (const auto& [id, intrinsic] : scene->intrinsics) {
    host.scene.intrinsics[id.value()] =
        std::make_shared<openMVG::cameras::Pinhole_Intrinsic>(
            intrinsic.width_px, intrinsic.height_px, intrinsic.fx_px,
            intrinsic.principal_point_px.x(), intrinsic.principal_point_px.y());
  }
  for (const auto& [id, view] : scene->views) {
    host.scene.views[id.value()] = std::make_shared<openMVG::sfm::View>(
        (std::filesystem::path(view.local_path) / view.filename).string(),
        id.value(), view.intrinsic_id.value(), view.pose_id.value(),
        view.width_px, view.height_px);
    std::ifstream file(
        matches_folder + "/" +
        view.filename.substr(0, view.filename.find_last_of('.')) + ".feat");
    auto& points = host.features.feats_per_view[id.value()];
    for (float x, y; file >> x >> y;) {
      file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
      points.emplace_back(x, y);
    }
  }
  const auto matches = openmvg::ReadMatches(matches_folder + "/" + match_file);
  if (!matches) return tl::unexpected<Error>(matches.error());
  for (const auto& [pair, of_pair] : *matches) {
    if (scene->views.count(pair.first) == 0 ||
        scene->views.count(pair.second) == 0) {
      continue;
    }
    auto& translated =
        host.matches
            .pairWise_matches_[{pair.first.value(), pair.second.value()}];
    for (const FeatureMatch& match : of_pair) {
      translated.emplace_back(match.first, match.second);
    }
  }
  return host;
}

/// Without their covariances, which a host's poses do not have.
inline std::map<PoseId, Pose> PosesOfHost(std::map<PoseId, Pose> poses) {
  for (auto& [id, pose] : poses) pose.center_covariance.reset();
  return poses;
}

/// The poses that the engine leaves in the host's scene, as lowlap's; empty if
/// it fails.
inline std::map<PoseId, Pose> PosesOfEngine(
    Host* host, LowlapGlobalEngine::Rotations rotations,
    const openmvg::TranslationStepOptions& options = {}) {
  LowlapGlobalEngine engine(host->scene, "");
  engine.SetFeaturesProvider(&host->features);
  engine.SetMatchesProvider(&host->matches);
  engine.SetRotations(rotations);
  engine.SetOptions(options);
  std::map<PoseId, Pose> poses;
  if (!engine.Process()) return poses;
  for (const auto& [id, pose] : engine.Get_SfM_Data().GetPoses()) {
    poses[id] = {pose.rotation(), pose.center()};
  }
  return poses;
}

}  // namespace lowlap
