#include "third_party_adapters/openmvg/internal/prepare.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "lowlap/core/internal/format.h"
#include "third_party_adapters/internal/landmarks.h"

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
  AddNote(DropUnused(out.intrinsics, used_intrinsics),
          "intrinsics that no view uses were left out", &notes);
  AddNote(DropUnused(out.poses, used_poses),
          "poses that no view uses were left out", &notes);

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

  out.structure = SolvedLandmarks(scene, &notes);
  return result;
}

}  // namespace lowlap::openmvg
