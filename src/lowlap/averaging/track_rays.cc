#include "lowlap/averaging/internal/track_rays.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "lowlap/averaging/internal/matched_tracks.h"

namespace lowlap {
namespace {

struct SceneView {
  std::size_t index;
  const Intrinsic* intrinsic;
  const std::vector<Vec2>* points_px;
};

using SceneViews = std::map<ViewId, SceneView>;

SceneViews UsableViews(const Scene& scene, const std::vector<ViewId>& views) {
  SceneViews usable;
  for (std::size_t n = 0; n < views.size(); ++n) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(views[n]);
    const auto features = scene.features.find(views[n]);
    if (intrinsic == nullptr || features == scene.features.end()) continue;
    usable[views[n]] = {n, intrinsic, &features->second.points_px};
  }
  return usable;
}

}  // namespace

std::vector<TrackRays> MakeTrackRays(const Scene& scene,
                                     const std::vector<ViewId>& views,
                                     const std::vector<Mat3>& cam_from_world,
                                     const std::vector<ViewPair>& excluded,
                                     std::size_t max_per_view) {
  const SceneViews usable = UsableViews(scene, views);
  struct Candidate {
    PointTrackId id;
    const Track* track;
    std::size_t length;
  };
  std::vector<Candidate> candidates;
  const std::map<PointTrackId, Track> all_tracks =
      MatchedTracks(scene, views, {excluded.begin(), excluded.end()});
  for (const auto& [id, track] : all_tracks) {
    const auto length = static_cast<std::size_t>(std::count_if(
        track.begin(), track.end(),
        [&](const FeatureRef& ref) { return usable.count(ref.view) > 0; }));
    if (length >= 2) candidates.push_back({id, &track, length});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) {
                     return a.length > b.length;
                   });

  std::vector<std::size_t> count(views.size(), 0);
  std::vector<std::pair<PointTrackId, TrackRays>> chosen;
  for (const Candidate& candidate : candidates) {
    TrackRays rays;
    bool is_wanted = false;
    for (const FeatureRef& ref : *candidate.track) {
      const auto found = usable.find(ref.view);
      if (found == usable.end()) continue;
      const SceneView& view = found->second;
      if (ref.feature >= view.points_px->size()) continue;
      const std::optional<Vec3> bearing =
          view.intrinsic->Bearing((*view.points_px)[ref.feature]);
      if (!bearing) continue;
      rays.observations.push_back(
          {view.index,
           (cam_from_world[view.index].transpose() * *bearing).normalized()});
      is_wanted = is_wanted || count[view.index] < max_per_view;
    }
    if (!is_wanted || rays.observations.size() < 2) continue;
    for (const RayObservation& seen : rays.observations) ++count[seen.view];
    chosen.emplace_back(candidate.id, std::move(rays));
  }
  std::sort(chosen.begin(), chosen.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<TrackRays> tracks;
  tracks.reserve(chosen.size());
  for (auto& entry : chosen) tracks.push_back(std::move(entry.second));
  return tracks;
}

std::vector<std::vector<std::size_t>> TracksOfViews(
    const std::vector<TrackRays>& tracks, std::size_t num_views,
    std::size_t min_views) {
  std::vector<std::vector<std::size_t>> tracks_of_view(num_views);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (tracks[t].observations.size() < min_views) continue;
    for (const RayObservation& seen : tracks[t].observations) {
      tracks_of_view[seen.view].push_back(t);
    }
  }
  return tracks_of_view;
}

}  // namespace lowlap
