#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>

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

/// Path, file name, and both without extension.
std::array<std::string, 4> NamesOf(const std::string& path) {
  const std::string base = path.substr(path.find_last_of('/') + 1);
  return {path, base, WithoutExtension(path), WithoutExtension(base)};
}

// The number that a file name ends in, as that of a frame.
std::optional<std::uint64_t> NumberOf(const View& view) {
  const std::string stem = NamesOf(view.filename)[3];
  const std::size_t before = stem.find_last_not_of("0123456789");
  const std::string digits =
      before == std::string::npos ? stem : stem.substr(before + 1);
  if (digits.empty() || digits.size() > 18) return std::nullopt;
  return std::stoull(digits);
}

// The truth of the frames that the files are named by; empty if a name has no
// number, or shares it.
GroundTruth GroundTruthByNumber(const GroundTruth& by_id, const Scene& scene) {
  GroundTruth truth;
  std::set<std::uint64_t> used;
  for (const auto& [id, view] : scene.views) {
    const auto number = NumberOf(view);
    if (!number || !used.insert(*number).second) return {};
    if (*number >= kInvalidId) continue;
    const auto found = by_id.find(static_cast<ViewId>(*number));
    if (found != by_id.end()) truth.emplace(id, found->second);
  }
  return truth;
}

// Truths whose images have no names: by id, or by the numbers of the files,
// whichever has more views, as programs count from zero or from one.
Result<GroundTruth> GroundTruthWithoutNames(const GroundTruth& by_id,
                                            const Scene& scene) {
  GroundTruth of_ids;
  for (const auto& entry : by_id) {
    if (scene.views.count(entry.first) > 0) of_ids.insert(entry);
  }
  GroundTruth of_numbers = GroundTruthByNumber(by_id, scene);
  if (of_numbers.size() > of_ids.size()) return of_numbers;
  if (of_numbers.size() == of_ids.size() && of_numbers != of_ids) {
    const auto differs = std::find_if(
        scene.views.begin(), scene.views.end(), [](const auto& entry) {
          return NumberOf(entry.second) != entry.first.value();
        });
    return MakeError(
        ErrorCode::kInvalidScene,
        "the true poses have no image names, and ids and file names tell "
        "different views apart: view " +
            std::to_string(differs->first.value()) + " is '" +
            differs->second.PathBelowRoot() + "'");
  }
  return of_ids;
}

/// Which name of a view is held against which of a truth, the most exact first.
/// Where any view has its truth's folder, folders tell images apart.
struct Level {
  std::size_t of_view, of_truth;
  bool drops_folders;
};
constexpr Level kLevels[] = {{0, 0, false}, {1, 0, false}, {2, 2, false},
                             {3, 2, false}, {1, 1, true},  {3, 3, true}};

// With leading zeros, too.
bool IsNumber(const std::string& name, std::uint32_t number) {
  const std::string digits = std::to_string(number);
  if (name.size() < digits.size()) return false;
  const std::size_t num_zeros = name.size() - digits.size();
  return name == std::string(num_zeros, '0') + digits;
}

}  // namespace

Result<GroundTruth> GroundTruthByName(
    const Scene& scene, const std::map<std::string, Pose>& pose_by_image) {
  GroundTruth truth;
  std::map<std::string, ViewId> assigned;  // truth name -> view
  // All views at one level of exactness before any at the next, so that an
  // exact name is never taken by a view that fits it loosely.
  bool is_matched_exactly = false;
  std::string shared_name;
  for (const Level& level : kLevels) {
    if (level.drops_folders && is_matched_exactly) break;
    // Nothing where two truths share a name.
    std::map<std::string, std::optional<std::string>> truth_by_name;
    for (const auto& [path, pose] : pose_by_image) {
      const auto [entry, inserted] =
          truth_by_name.emplace(NamesOf(path)[level.of_truth], path);
      if (!inserted) entry->second.reset();
    }
    std::map<std::string, ViewId> assigned_here;
    for (const auto& [id, view] : scene.views) {
      if (truth.count(id)) continue;
      const auto found =
          truth_by_name.find(NamesOf(view.PathBelowRoot())[level.of_view]);
      if (found == truth_by_name.end()) continue;
      if (!found->second) {
        if (shared_name.empty()) shared_name = found->first;
        continue;
      }
      const std::string& name = *found->second;
      if (assigned.count(name)) continue;
      const auto [entry, inserted] = assigned_here.emplace(name, id);
      if (!inserted) {
        return MakeError(ErrorCode::kInvalidScene,
                         "the pose of '" + name + "' fits views " +
                             std::to_string(entry->second.value()) + " and " +
                             std::to_string(id.value()) + " equally well");
      }
      truth.emplace(id, pose_by_image.at(name));
    }
    assigned.insert(assigned_here.begin(), assigned_here.end());
    if (!level.drops_folders) is_matched_exactly = !truth.empty();
  }
  if (truth.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     shared_name.empty()
                         ? "no view of the scene has a true pose: no image "
                           "name occurs in the ground truth"
                         : "no view of the scene has a true pose: several "
                           "images of the ground truth are called '" +
                               shared_name + "'");
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
  bool names_are_ids = true;
  for (const auto& [id, pose] : by_id) {
    const std::string name = truth.views.at(id).PathBelowRoot();
    names_are_ids = names_are_ids && IsNumber(name, id.value());
    by_name.emplace(name, pose);
  }
  if (by_name.empty() || by_name.size() < by_id.size()) {
    return GroundTruthWithoutNames(by_id, scene);
  }
  auto named = GroundTruthByName(scene, by_name);
  const bool is_nothing_named =
      !named && named.error().code == ErrorCode::kInsufficientData;
  if (is_nothing_named && names_are_ids) {
    return GroundTruthWithoutNames(by_id, scene);
  }
  return named;
}

}  // namespace lowlap
