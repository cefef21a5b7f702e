#include "third_party_adapters/openmvg/internal/prepare.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "lowlap/core/internal/format.h"

namespace lowlap::openmvg {
namespace {

template <class Map>
std::size_t DropUnused(Map& map, const std::set<typename Map::key_type>& used) {
  std::size_t dropped = 0;
  for (auto entry = map.begin(); entry != map.end();) {
    if (used.count(entry->first)) {
      ++entry;
    } else {
      entry = map.erase(entry);
      ++dropped;
    }
  }
  return dropped;
}

void AddCount(std::size_t count, const char* what,
              std::vector<std::string>& notes) {
  if (count > 0) notes.push_back(std::to_string(count) + " " + what);
}

}  // namespace

PreparedScene PrepareForOpenMvg(const Scene& scene) {
  PreparedScene result;
  std::vector<std::string>& notes = result.notes;
  Scene& out = result.scene;
  out.root_path = scene.root_path;
  out.views = scene.views;
  out.intrinsics = scene.intrinsics;
  out.poses = scene.poses;
  out.control_points = scene.control_points;

  std::set<IntrinsicId> used_intrinsics;
  std::set<PoseId> used_poses;
  for (const auto& [id, view] : out.views) {
    used_intrinsics.insert(view.intrinsic_id);
    used_poses.insert(view.pose_id);
  }
  AddCount(DropUnused(out.intrinsics, used_intrinsics),
           "intrinsics that no view uses were left out", notes);
  AddCount(DropUnused(out.poses, used_poses),
           "poses that no view uses were left out", notes);

  std::size_t num_averaged = 0;
  double largest_change = 0;
  for (auto& [id, intrinsic] : out.intrinsics) {
    if (intrinsic.model == CameraModel::kSpherical ||
        intrinsic.fx_px == intrinsic.fy_px) {
      continue;
    }
    const double mean = intrinsic.MeanFocalPx();
    largest_change =
        std::max(largest_change, std::abs(intrinsic.fx_px - mean) / mean);
    intrinsic.fx_px = intrinsic.fy_px = mean;
    ++num_averaged;
  }
  if (num_averaged > 0) {
    notes.push_back(std::to_string(num_averaged) +
                    " intrinsics have fx and fy of their own; OpenMVG holds "
                    "only their mean, which differs by up to " +
                    Format("%.3g %%", 100.0 * largest_change));
  }

  std::size_t num_observations = 0, num_landmarks = 0;
  for (const auto& [id, landmark] : scene.structure) {
    Landmark kept;
    kept.position = landmark.position;
    for (const PointObservation& observation : landmark.observations) {
      if (out.views.count(observation.view) && out.FindPose(observation.view) &&
          out.FindIntrinsic(observation.view)) {
        kept.observations.push_back(observation);
      } else {
        ++num_observations;
      }
    }
    if (kept.observations.size() >= 2) {
      out.structure.emplace_hint(out.structure.end(), id, std::move(kept));
    } else {
      ++num_landmarks;
    }
  }
  AddCount(num_observations,
           "observations from views without a pose or an intrinsic were left "
           "out",
           notes);
  AddCount(num_landmarks,
           "landmarks with fewer than two observations were left out", notes);

  const bool has_own_content =
      !scene.features.empty() || !scene.relative_poses.empty() ||
      !scene.point_tracks.empty() || !scene.line_tracks.empty() ||
      !scene.scale_ratios.empty() || !scene.line_structure.empty() ||
      !scene.coplanar_pairs.empty();
  if (has_own_content) {
    notes.push_back(
        "features, tracks, relative poses, scale ratios, lines and coplanar "
        "pairs have no place in OpenMVG's format and were left out");
  }
  return result;
}

}  // namespace lowlap::openmvg
