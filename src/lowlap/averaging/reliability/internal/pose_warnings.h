#pragma once

#include <string>
#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What a person has to know before relying on the poses, one sentence each,
/// with image names: what was left out and why, what hangs on a contested
/// relative pose, which loop does not close, how much nothing checks, and which
/// views are not placed. Empty if all is well.
std::vector<std::string> PoseWarnings(const PoseSummary& summary,
                                      const Scene& scene);

/// The same, each with the views whose place it is about: none where it is
/// about relative poses.
struct PoseWarning {
  std::string text;
  std::vector<ViewId> views;
  /// What it shares with others of its kind: no names, no full stop.
  std::string cause;
};

std::vector<PoseWarning> PoseWarningsByView(const PoseSummary& summary,
                                            const Scene& scene);

/// In short: one sentence for every cause, with the names of all views that it
/// is about.
std::vector<std::string> PoseWarningsByCause(const PoseSummary& summary,
                                             const Scene& scene);

}  // namespace lowlap
