#include "lowlap/scene/scene.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace lowlap {
namespace {

std::size_t NumViews(const Track& track) {
  std::set<ViewId> views;
  for (const FeatureRef& ref : track) views.insert(ref.view);
  return views.size();
}

}  // namespace

Scene::Scene() = default;
Scene::~Scene() = default;
Scene::Scene(const Scene& other) = default;
Scene& Scene::operator=(const Scene& other) = default;
Scene::Scene(Scene&& other) noexcept = default;
Scene& Scene::operator=(Scene&& other) noexcept = default;

const Intrinsic* Scene::FindIntrinsic(ViewId view) const {
  const auto v = views.find(view);
  if (v == views.end()) return nullptr;
  const auto i = intrinsics.find(v->second.intrinsic_id);
  return i == intrinsics.end() ? nullptr : &i->second;
}

const Pose* Scene::FindPose(ViewId view) const {
  const auto v = views.find(view);
  if (v == views.end()) return nullptr;
  const auto p = poses.find(v->second.pose_id);
  return p == poses.end() ? nullptr : &p->second;
}

const RelativePose* Scene::FindRelativePose(ViewId a, ViewId b) const {
  const auto edge = relative_poses.find({std::min(a, b), std::max(a, b)});
  return edge == relative_poses.end() ? nullptr : &edge->second;
}

std::string Scene::ImagePath(ViewId view) const {
  const View& v = views.at(view);
  namespace fs = std::filesystem;
  return (fs::path(root_path) / fs::path(v.local_path) / v.filename).string();
}

std::string Scene::NameOf(ViewId view) const {
  const auto found = views.find(view);
  return found == views.end() || found->second.filename.empty()
             ? std::to_string(view.value())
             : found->second.PathBelowRoot();
}

bool operator==(const Scene& a, const Scene& b) {
  return a.root_path == b.root_path && a.views == b.views &&
         a.intrinsics == b.intrinsics &&
         a.given_intrinsics == b.given_intrinsics && a.poses == b.poses &&
         a.features == b.features && a.relative_poses == b.relative_poses &&
         a.unrelated_pairs == b.unrelated_pairs &&
         a.point_tracks == b.point_tracks && a.line_tracks == b.line_tracks &&
         a.scale_ratios == b.scale_ratios && a.structure == b.structure &&
         a.line_structure == b.line_structure &&
         a.coplanar_pairs == b.coplanar_pairs &&
         a.control_points == b.control_points;
}

Scene WithoutViews(const Scene& scene, const std::vector<ViewId>& excluded) {
  const std::set<ViewId> gone(excluded.begin(), excluded.end());
  const auto is_gone = [&](ViewId view) { return gone.count(view) > 0; };
  const auto erase_if = [](auto& map, const auto& predicate) {
    for (auto it = map.begin(); it != map.end();) {
      it = predicate(*it) ? map.erase(it) : std::next(it);
    }
  };
  const auto shrink = [&](auto& observations) {
    observations.erase(
        std::remove_if(observations.begin(), observations.end(),
                       [&](const auto& o) { return is_gone(o.view); }),
        observations.end());
  };

  Scene kept = scene;
  erase_if(kept.views, [&](const auto& e) { return is_gone(e.first); });
  erase_if(kept.features, [&](const auto& e) { return is_gone(e.first); });
  const auto misses_view = [&](const ViewPair& views) {
    return is_gone(views.first) || is_gone(views.second);
  };
  erase_if(kept.relative_poses,
           [&](const auto& e) { return misses_view(e.first); });
  kept.unrelated_pairs.erase(
      std::remove_if(kept.unrelated_pairs.begin(), kept.unrelated_pairs.end(),
                     misses_view),
      kept.unrelated_pairs.end());
  std::set<PoseId> used_poses;
  std::set<IntrinsicId> used_intrinsics;
  for (const auto& [id, view] : kept.views) {
    used_poses.insert(view.pose_id);
    used_intrinsics.insert(view.intrinsic_id);
  }
  erase_if(kept.poses,
           [&](const auto& e) { return used_poses.count(e.first) == 0; });
  for (auto* intrinsics : {&kept.intrinsics, &kept.given_intrinsics}) {
    erase_if(*intrinsics, [&](const auto& e) {
      return used_intrinsics.count(e.first) == 0;
    });
  }

  const auto shrinks_too_far = [&](auto& e) {
    shrink(e.second);
    return NumViews(e.second) < 2;
  };
  erase_if(kept.point_tracks, shrinks_too_far);
  erase_if(kept.line_tracks, shrinks_too_far);
  erase_if(kept.structure, [&](auto& e) {
    shrink(e.second.observations);
    return e.second.observations.size() < 2;
  });
  erase_if(kept.line_structure, [&](auto& e) {
    shrink(e.second.observations);
    return NumViews(e.second.observations) < 2;
  });
  for (auto& [id, point] : kept.control_points) shrink(point.observations);
  const auto has_line = [&](LineTrackId id) {
    return kept.line_structure.count(id) > 0;
  };
  kept.coplanar_pairs.erase(
      std::remove_if(kept.coplanar_pairs.begin(), kept.coplanar_pairs.end(),
                     [&](const CoplanarPair& pair) {
                       return !has_line(pair.first) || !has_line(pair.second);
                     }),
      kept.coplanar_pairs.end());
  kept.scale_ratios.erase(
      std::remove_if(kept.scale_ratios.begin(), kept.scale_ratios.end(),
                     [&](const ScaleRatio& r) {
                       return is_gone(r.views.first) ||
                              is_gone(r.views.middle) || is_gone(r.views.last);
                     }),
      kept.scale_ratios.end());
  return kept;
}

}  // namespace lowlap
