#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scale/evidence/evidence_kind.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Everything a solving command has to say about its run.
struct RunSummary {
  std::string command;
  std::vector<PairReport> pairs;
  std::vector<UnrelatedView> unrelated;
  /// All features of the photographs, if they were detected in this run.
  std::map<ViewId, ViewFeatures> detected;
  /// What a command has to say beyond that, for people.
  std::vector<std::string> notes;
  std::optional<SolveResult> solve;
  /// The poses of `solve` came with the scene: how they were found, and how far
  /// each can be trusted, is not known.
  bool has_given_poses = false;
  std::optional<PoseEvaluation> evaluation_before_adjustment;
  std::optional<PoseEvaluation> evaluation;
  /// What the two are made against.
  std::optional<GroundTruth> truth;
  /// What the ratios were estimated from; empty: the page has no profiles.
  EvidenceKinds kinds;
  std::vector<StageCost> stages;
};

/// Whether results can be put into the folder: it is one that can be written
/// to, or can be made. Makes nothing; for asking before long work. kIo if a
/// file is in the way or a folder cannot be written to.
Status CheckOutputFolder(const std::string& folder);

/// The paths of what WriteOutputs writes.
std::vector<std::string> OutputFiles(const std::string& folder);

/// Makes the folder and writes what every solving command leaves, as a FileSet:
/// sfm_data.json (OpenMVG loads it), scene.lowlap (everything), cloud.ply
/// (points, lines, cameras), report.html (for a person) and summary.json (for
/// a program). A relative root_path is made absolute, since the files move away
/// from what it was relative to. The page shows the photographs, if they are
/// where the scene says. `before_commit`, if it is not null, gets the scene
/// once all files are prepared. Errors: kIo; kCancelled; those of
/// `before_commit`; with nothing written.
Status WriteOutputs(
    Scene scene, const RunSummary& summary, const RunContext& context,
    const std::string& folder,
    const std::function<Status(const Scene&)>& before_commit = nullptr);

}  // namespace lowlap
