#pragma once

#include <third_party_adapters/openmvg/engine/host_types.h>

#include <iostream>
#include <utility>

#include "openMVG/sfm/pipelines/global/sfm_global_engine_relative_motions.hpp"
#include "openMVG/sfm/pipelines/relative_pose_engine.hpp"
#include "openMVG/sfm/pipelines/sfm_features_provider.hpp"
#include "openMVG/sfm/pipelines/sfm_matches_provider.hpp"

/// OpenMVG's GLOBAL engine with lowlap's translation step. In OpenMVG's
/// main_SfM.cpp it takes the place of
/// GlobalSfMReconstructionEngine_RelativeMotions, with the same arguments and
/// setters (but for the translation averaging method, which is not read).
class LowlapGlobalEngine final
    : public openMVG::sfm::GlobalSfMReconstructionEngine_RelativeMotions {
  using Base = openMVG::sfm::GlobalSfMReconstructionEngine_RelativeMotions;

 public:
  using Base::Base;

  enum class Rotations {
    /// OpenMVG's, which need every view in a triplet of relative rotations.
    kHost,
    /// lowlap's, from its own relative poses: chains of photographs, too.
    kLowlap,
  };
  void SetRotations(Rotations rotations) { rotations_ = rotations; }
  void SetOptions(const lowlap::openmvg::TranslationStepOptions& options) {
    options_ = options;
  }

  // The base class keeps its providers to itself.
  void SetFeaturesProvider(openMVG::sfm::Features_Provider* provider) {
    Base::SetFeaturesProvider(features_ = provider);
  }
  void SetMatchesProvider(openMVG::sfm::Matches_Provider* provider) {
    Base::SetMatchesProvider(matches_ = provider);
  }

  bool Process() override {
    // Views on one edge only may stay: lowlap tells which it can place.
    openMVG::rotation_averaging::RelativeRotations relative_rotations;
    openMVG::Hash_Map<openMVG::IndexT, openMVG::Mat3> global_rotations;
    if (rotations_ == Rotations::kHost) {
      openMVG::sfm::Relative_Pose_Engine engine;
      if (!engine.Process(sfm_data_, matches_, features_)) return false;
      for (const auto& [pair, pose] : engine.Get_Relative_Poses()) {
        relative_rotations.emplace_back(pair.first, pair.second,
                                        pose.rotation());
      }
      if (!Compute_Global_Rotations(relative_rotations, global_rotations)) {
        return false;
      }
    }

    openMVG::matching::PairWiseMatches inliers;
    // ---- in place of Compute_Global_Translations: begin ----
    namespace step = lowlap::openmvg;
    auto input = step::FromHost(sfm_data_, *features_, *matches_);
    if (rotations_ == Rotations::kHost) {
      step::AddRotations(global_rotations, &input);
      step::KeepPairsOf(relative_rotations, &input);
    }
    const auto result = step::RunTranslationStep(std::move(input), options_);
    if (!result) {
      std::cerr << "lowlap: " << result.error().ToString() << '\n';
      return false;
    }
    for (const auto& warning : result->warnings) std::cerr << warning << '\n';
    step::ToHost(*result, &sfm_data_, &inliers);
    // ---- in place of Compute_Global_Translations: end ----

    return Compute_Initial_Structure(inliers) && Adjust();
  }

 private:
  Rotations rotations_ = Rotations::kHost;
  lowlap::openmvg::TranslationStepOptions options_;
  openMVG::sfm::Features_Provider* features_ = nullptr;
  openMVG::sfm::Matches_Provider* matches_ = nullptr;
};
