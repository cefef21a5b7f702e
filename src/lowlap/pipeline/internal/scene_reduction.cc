#include "lowlap/pipeline/internal/scene_reduction.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"

namespace lowlap {
namespace {

// Old index -> new index of the kept features of one kind in one view.
class Renumbering {
 public:
  explicit Renumbering(std::size_t count) : new_index_(count, kInvalidId) {}

  void Keep(FeatureIndex old_index) {
    if (old_index < new_index_.size()) new_index_[old_index] = 0;
  }

  /// Gives the kept features their new indices.
  void Number() {
    FeatureIndex next = 0;
    for (FeatureIndex& index : new_index_) {
      if (index != kInvalidId) index = next++;
    }
  }

  template <class T>
  void Compact(std::vector<T>* features) const {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < features->size(); ++n) {
      if (new_index_[n] != kInvalidId) (*features)[kept++] = (*features)[n];
    }
    features->resize(kept);
  }

  /// Of a list of indices those that are kept, renumbered.
  void KeepKnown(std::vector<FeatureIndex>* indices) const {
    std::vector<FeatureIndex> kept;
    for (const FeatureIndex index : *indices) {
      if (index < new_index_.size() && new_index_[index] != kInvalidId) {
        kept.push_back(new_index_[index]);
      }
    }
    *indices = std::move(kept);
  }

  void Apply(FeatureIndex* index) const {
    if (*index < new_index_.size()) *index = new_index_[*index];
  }

 private:
  std::vector<FeatureIndex> new_index_;
};

// Calls visit(view, index) for every reference to a feature of a kind.
template <class Visit>
void VisitPointRefs(Scene* scene, const Visit& visit) {
  for (auto& [views, pose] : scene->relative_poses) {
    for (FeatureMatch& match : pose.point_inliers) {
      visit(views.first, &match.first);
      visit(views.second, &match.second);
    }
  }
  for (auto& [id, track] : scene->point_tracks) {
    for (FeatureRef& ref : track) visit(ref.view, &ref.feature);
  }
  for (auto& [id, landmark] : scene->structure) {
    for (PointObservation& o : landmark.observations) visit(o.view, &o.feature);
  }
}

template <class Visit>
void VisitSegmentRefs(Scene* scene, const Visit& visit) {
  for (auto& [views, pose] : scene->relative_poses) {
    for (FeatureMatch& match : pose.line_inliers) {
      visit(views.first, &match.first);
      visit(views.second, &match.second);
    }
  }
  for (auto& [id, track] : scene->line_tracks) {
    for (FeatureRef& ref : track) visit(ref.view, &ref.feature);
  }
  for (auto& [id, landmark] : scene->line_structure) {
    for (FeatureRef& ref : landmark.observations) visit(ref.view, &ref.feature);
  }
  for (ScaleRatio& ratio : scene->scale_ratios) {
    for (CoplanarInlier& inlier : ratio.coplanar_inliers) {
      visit(ratio.views.middle, &inlier.line_in_first);
      visit(ratio.views.middle, &inlier.line_in_last);
    }
  }
}

}  // namespace

void KeepMatchedFeatures(Scene* scene) {
  std::map<ViewId, Renumbering> points, segments;
  for (const auto& [view, features] : scene->features) {
    points.emplace(view, Renumbering(features.points_px.size()));
    segments.emplace(view, Renumbering(features.segments.size()));
  }
  VisitPointRefs(scene, [&](ViewId view, FeatureIndex* index) {
    if (points.count(view) > 0) points.at(view).Keep(*index);
  });
  VisitSegmentRefs(scene, [&](ViewId view, FeatureIndex* index) {
    if (segments.count(view) > 0) segments.at(view).Keep(*index);
  });
  for (auto& [view, features] : scene->features) {
    points.at(view).Number();
    segments.at(view).Number();
    points.at(view).Compact(&features.points_px);
    points.at(view).Compact(&features.point_covariances);
    points.at(view).KeepKnown(&features.repeated_points);
    segments.at(view).Compact(&features.segments);
    segments.at(view).KeepKnown(&features.repeated_segments);
  }
  VisitPointRefs(scene, [&](ViewId view, FeatureIndex* index) {
    if (points.count(view) > 0) points.at(view).Apply(index);
  });
  VisitSegmentRefs(scene, [&](ViewId view, FeatureIndex* index) {
    if (segments.count(view) > 0) segments.at(view).Apply(index);
  });
}

Scene SceneOfPairs(const Scene& scene,
                   const std::map<ViewPair, std::size_t>& hypotheses) {
  Scene part;
  for (const auto& [views, hypothesis] : hypotheses) {
    part.relative_poses[views] =
        WithHypothesis(scene.relative_poses.at(views), hypothesis);
    for (const ViewId id : {views.first, views.second}) {
      const View& view = scene.views.at(id);
      if (!part.views.emplace(id, view).second) continue;
      if (const Intrinsic* intrinsic = scene.FindIntrinsic(id)) {
        part.intrinsics[view.intrinsic_id] = *intrinsic;
      }
      const auto features = scene.features.find(id);
      if (features != scene.features.end()) part.features.insert(*features);
    }
  }
  for (const auto& [id, track] : scene.line_tracks) {
    for (const FeatureRef& ref : track) {
      if (part.views.count(ref.view) > 0) part.line_tracks[id].push_back(ref);
    }
  }
  return part;
}

void DropSolution(Scene* scene) {
  scene->scale_ratios.clear();
  scene->poses.clear();
  scene->structure.clear();
  scene->line_structure.clear();
  scene->coplanar_pairs.clear();
}

Status LimitPointMatches(int max_per_pair, Scene* scene) {
  if (max_per_pair <= 0) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the number of point matches per pair must be positive");
  }
  DropSolution(scene);
  std::map<FeatureRef, std::size_t> track_length;
  for (const auto& [id, track] : scene->point_tracks) {
    for (const FeatureRef& ref : track) track_length[ref] = track.size();
  }
  for (auto& [views, pose] : scene->relative_poses) {
    std::vector<FeatureMatch>& matches = pose.point_inliers;
    const auto length = [&, first = views.first](const FeatureMatch& match) {
      const auto found = track_length.find({first, match.first});
      return found == track_length.end() ? 0 : found->second;
    };
    std::stable_sort(matches.begin(), matches.end(),
                     [&](const FeatureMatch& a, const FeatureMatch& b) {
                       return length(a) > length(b);
                     });
    if (matches.size() > static_cast<std::size_t>(max_per_pair)) {
      matches.resize(static_cast<std::size_t>(max_per_pair));
    }
    std::sort(matches.begin(), matches.end());
  }
  scene->point_tracks = BuildPointTracks(*scene);
  KeepMatchedFeatures(scene);
  return {};
}

}  // namespace lowlap
