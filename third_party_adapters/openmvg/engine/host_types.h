#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "third_party_adapters/openmvg/engine/translation_step.h"

/// OpenMVG's types (2.1) to lowlap's and back. These are templates, so that
/// lowlap needs no OpenMVG; they touch public members alone:
///   SfM_Data: s_root_path, views, intrinsics, poses;  View: s_Img_path, ids,
///   ui_width, ui_height;  IntrinsicBase: getType, getParams, w, h;
///   Features_Provider: feats_per_view;  PointFeature: x, y;
///   Matches_Provider: pairWise_matches_;  IndMatch: i_, j_;
///   RelativeRotation: i, j;  Pose3: rotation, center, translation.
/// A host that stores the same under other names fills a TranslationStepInput.
/// No value that passes has an Eigen type whose alignment depends on the
/// instruction set, so that the host may be compiled for another than lowlap.
namespace lowlap::openmvg {

/// An intrinsic from the number of OpenMVG's camera model (EINTRINSIC) and its
/// parameters (focal length, principal point, distortion); kUnsupported for
/// another model.
Result<Intrinsic> IntrinsicFromHost(int model, int width_px, int height_px,
                                    const std::vector<double>& parameters);

/// Directory and file name from the path below the root.
View ViewFromHost(const std::string& path, std::uint32_t intrinsic,
                  std::uint32_t pose, std::uint32_t width_px,
                  std::uint32_t height_px);

/// The position that the .feat file holds for a number in single precision: the
/// shortest decimal number that stands for it.
double PositionFromHost(float number);

/// Adds the matches of two views, in either order; pairs of views that the
/// scene does not have are left out.
void AddMatches(std::uint32_t first, std::uint32_t second,
                std::vector<FeatureMatch> matches, TranslationStepInput* input);

/// openMVG::sfm::SfM_Data, Features_Provider and Matches_Provider.
template <class SfmData, class FeaturesProvider, class MatchesProvider>
TranslationStepInput FromHost(const SfmData& sfm_data,
                              const FeaturesProvider& features,
                              const MatchesProvider& matches) {
  TranslationStepInput input;
  input.scene.root_path = sfm_data.s_root_path;
  for (const auto& [id, intrinsic] : sfm_data.intrinsics) {
    if (intrinsic == nullptr) continue;
    auto translated = IntrinsicFromHost(static_cast<int>(intrinsic->getType()),
                                        static_cast<int>(intrinsic->w()),
                                        static_cast<int>(intrinsic->h()),
                                        intrinsic->getParams());
    if (!translated) {
      translated.error().place = "intrinsic " + std::to_string(id);
      input.error = translated.error();
      return input;
    }
    input.scene.intrinsics[id] = std::move(*translated);
  }
  for (const auto& [id, view] : sfm_data.views) {
    if (view == nullptr) continue;
    input.scene.views[id] =
        ViewFromHost(view->s_Img_path, view->id_intrinsic, view->id_pose,
                     view->ui_width, view->ui_height);
    std::vector<Vec2>& points = input.scene.features[id].points_px;
    const auto of_view = features.feats_per_view.find(id);
    if (of_view == features.feats_per_view.end()) continue;
    for (const auto& point : of_view->second) {
      points.emplace_back(PositionFromHost(point.x()),
                          PositionFromHost(point.y()));
    }
  }
  for (const auto& [pair, of_pair] : matches.pairWise_matches_) {
    std::vector<FeatureMatch> translated;
    for (const auto& match : of_pair)
      translated.push_back({match.i_, match.j_});
    AddMatches(pair.first, pair.second, std::move(translated), &input);
  }
  return input;
}

/// Hash_Map<IndexT, Mat3>, by pose: they are kept, instead of averaged anew.
template <class Rotations>
void AddRotations(const Rotations& rotations, TranslationStepInput* input) {
  for (const auto& [pose, rotation] : rotations) {
    input->rotations[pose] = rotation;
  }
}

/// rotation_averaging::RelativeRotations: lowlap uses these pairs alone. It
/// takes no rotation from them, since it needs directions too.
template <class RelativeRotations>
void KeepPairsOf(const RelativeRotations& rotations,
                 TranslationStepInput* input) {
  input->pairs.emplace();
  for (const auto& rotation : rotations) {
    input->pairs->emplace(rotation.i, rotation.j);
  }
}

/// Relative_Pose_Engine::Relative_Pair_Poses: lowlap takes these, instead of
/// estimating them from the matches.
template <class RelativePoses>
void AddRelativePoses(const RelativePoses& poses, TranslationStepInput* input) {
  for (const auto& [pair, pose] : poses) {
    input->relative_poses[{pair.first, pair.second}] = {pose.rotation(),
                                                        pose.translation()};
  }
}

/// The placed poses into sfm_data.poses, which holds no others then, and the
/// inlier matches into `matches` (matching::PairWiseMatches), which the host
/// triangulates.
template <class SfmData, class PairWiseMatches>
void ToHost(const TranslationStepResult& result, SfmData* sfm_data,
            PairWiseMatches* matches) {
  using Pose3 = typename decltype(sfm_data->poses)::mapped_type;
  sfm_data->poses.clear();
  for (const auto& [id, pose] : result.poses) {
    sfm_data->poses[id.value()] = Pose3(pose.rotation, pose.center);
  }
  matches->clear();
  for (const auto& [pair, inliers] : result.inliers) {
    auto& of_pair = (*matches)[{pair.first.value(), pair.second.value()}];
    for (const FeatureMatch& match : inliers) {
      of_pair.emplace_back(match.first, match.second);
    }
  }
}

}  // namespace lowlap::openmvg
