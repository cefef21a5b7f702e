#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap::openmvg {

using PosePair = std::pair<PoseId, PoseId>;

/// What OpenMVG holds before its global translation step, in lowlap's types;
/// host_types.h fills it from OpenMVG's.
struct TranslationStepInput {
  /// root_path, views, intrinsics, and the points of the features.
  Scene scene;
  std::map<ViewPair, std::vector<FeatureMatch>> matches;  // first < second
  /// Global rotations, camera from world, which are kept; views without one are
  /// not placed. None at all: lowlap averages rotations itself.
  std::map<PoseId, Mat3> rotations;
  /// Known relative poses, x_second = rotation x_first + translation at any
  /// length; all matches of such a pair are believed. The relative poses of the
  /// other pairs are estimated from their matches.
  std::map<PosePair, RigidTransform> relative_poses;
  /// If set: only these pairs (in either order) are used.
  std::optional<std::set<PosePair>> pairs;
  /// What could not be translated.
  std::optional<Error> error;
};

struct TranslationStepOptions {
  TranslationStepOptions() { solve.adjust = false; }

  RelativePoseOptions relative_poses;
  /// The estimator of ratios and the averaging strategy. With `solve.adjust`
  /// the poses are refined on points, lines and coplanar pairs as well, as far
  /// as there are any (FinishSolution).
  SolveOptions solve;
  /// Lines are detected and matched in the photographs that there are.
  bool use_photographs = true;
};

struct TranslationStepResult {
  std::map<PoseId, Pose> poses;
  std::vector<ViewId> unplaced;
  /// The matches that bear out the relative poses between placed views.
  std::map<ViewPair, std::vector<FeatureMatch>> inliers;
  /// What a person has to know before relying on the poses: what is not placed,
  /// left out or doubtful, with the names of images, and why.
  std::vector<std::string> warnings;
};

/// The global translation step. Without rotations, relative poses, pairs and
/// photographs the poses are to the byte those of `lowlap solve --no-adjust`
/// (with `solve.adjust`: of `lowlap solve`) on the same project's files, at the
/// same seed.
///
/// Errors: input.error; kInvalidScene (views, intrinsics or matches that do not
/// fit together, a matrix that is no rotation); kInsufficientData if no
/// relative pose is found, with the reasons; those of SolveScene; kCancelled.
Result<TranslationStepResult> RunTranslationStep(
    TranslationStepInput input, const TranslationStepOptions& options = {},
    const RunContext& context = {});

}  // namespace lowlap::openmvg
