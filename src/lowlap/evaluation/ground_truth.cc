#include <array>
#include <cctype>
#include <cstddef>

#include "lowlap/evaluation/pose_errors.h"

namespace lowlap {
namespace {

// An extension starts with a letter: timestamps have none.
std::string WithoutExtension(const std::string& name) {
  const std::size_t slash = name.find_last_of('/');
  const std::size_t dot = name.find_last_of('.');
  const bool has_extension =
      dot != std::string::npos && dot != 0 &&
      (slash == std::string::npos || dot > slash + 1) &&
      dot + 1 < name.size() &&
      std::isalpha(static_cast<unsigned char>(name[dot + 1])) != 0;
  return has_extension ? name.substr(0, dot) : name;
}

/// The names of a view, the most exact first.
std::array<std::string, 3> NamesOf(const View& view) {
  const std::string path = view.local_path.empty()
                               ? view.filename
                               : view.local_path + "/" + view.filename;
  const std::string base =
      view.filename.substr(view.filename.find_last_of('/') + 1);
  return {path, base, WithoutExtension(base)};
}

}  // namespace

Result<GroundTruth> GroundTruthByName(
    const Scene& scene, const std::map<std::string, Pose>& pose_by_image) {
  GroundTruth truth;
  std::map<std::string, ViewId> assigned;  // truth name -> view
  // Truth by its name without extension; nullptr where two truths share it.
  std::map<std::string, const std::string*> name_by_stem;
  for (const auto& [name, pose] : pose_by_image) {
    const auto [entry, inserted] =
        name_by_stem.emplace(WithoutExtension(name), &name);
    if (!inserted) entry->second = nullptr;
  }
  // All views at one level of exactness before any at the next, so that an
  // exact name is never taken by a view that fits it loosely.
  for (std::size_t level = 0; level < 3; ++level) {
    std::map<std::string, ViewId> assigned_here;
    for (const auto& [id, view] : scene.views) {
      if (truth.count(id)) continue;
      std::string name = NamesOf(view)[level];
      if (level == 2) {
        const auto found = name_by_stem.find(name);
        if (found == name_by_stem.end() || found->second == nullptr) continue;
        name = *found->second;
      }
      const auto pose = pose_by_image.find(name);
      if (pose == pose_by_image.end() || assigned.count(name)) continue;
      const auto [entry, inserted] = assigned_here.emplace(name, id);
      if (!inserted) {
        return MakeError(ErrorCode::kInvalidScene,
                         "the pose of '" + name + "' fits views " +
                             std::to_string(entry->second.value()) + " and " +
                             std::to_string(id.value()) + " equally well");
      }
      truth.emplace(id, pose->second);
    }
    assigned.insert(assigned_here.begin(), assigned_here.end());
  }
  if (truth.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     "no view of the scene has a true pose: no image name "
                     "occurs in the ground truth");
  }
  return truth;
}

GroundTruth GroundTruthFromScene(const Scene& truth) {
  GroundTruth result;
  for (const auto& [id, view] : truth.views) {
    if (const Pose* pose = truth.FindPose(id)) result.emplace(id, *pose);
  }
  return result;
}

Result<GroundTruth> GroundTruthFromScene(const Scene& truth,
                                         const Scene& scene) {
  GroundTruth by_id = GroundTruthFromScene(truth);
  std::map<std::string, Pose> by_name;
  for (const auto& [id, pose] : by_id) {
    by_name.emplace(NamesOf(truth.views.at(id)).front(), pose);
  }
  if (by_name.size() < by_id.size()) return by_id;
  auto named = GroundTruthByName(scene, by_name);
  if (!named && named.error().code == ErrorCode::kInsufficientData) {
    return by_id;
  }
  return named;
}

}  // namespace lowlap
