#include "lowlap/pipeline/calibrate_images.h"

#include <utility>

#include "lowlap/matching/pair_selection.h"

namespace lowlap {
namespace {

// Old index -> new index of the kept features of one kind in one view.
class Renumbering {
 public:
  explicit Renumbering(std::size_t count) : new_index_(count, kInvalidId) {}

  void Keep(FeatureIndex old_index) {
    if (old_index < new_index_.size()) new_index_[old_index] = 0;
  }

  template <class T>
  void Compact(std::vector<T>* features) {
    FeatureIndex next = 0;
    for (std::size_t n = 0; n < new_index_.size(); ++n) {
      if (new_index_[n] == kInvalidId) continue;
      (*features)[next] = (*features)[n];
      new_index_[n] = next++;
    }
    features->resize(next);
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

Status FrontEndOptions::Validate() const {
  for (const Status& valid :
       {features.Validate(), matching.Validate(), relative_poses.Validate()}) {
    if (!valid) return valid;
  }
  return {};
}

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
    points.at(view).Compact(&features.points_px);
    segments.at(view).Compact(&features.segments);
  }
  VisitPointRefs(scene, [&](ViewId view, FeatureIndex* index) {
    if (points.count(view) > 0) points.at(view).Apply(index);
  });
  VisitSegmentRefs(scene, [&](ViewId view, FeatureIndex* index) {
    if (segments.count(view) > 0) segments.at(view).Apply(index);
  });
}

Result<std::vector<PairReport>> MeasureImages(Scene* scene,
                                              const FrontEndOptions& options,
                                              const RunContext& context,
                                              StageLog* stages) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  const auto pairs = SelectPairs(*scene, options.pairs);
  if (!pairs) return tl::unexpected<Error>(pairs.error());

  std::map<ViewId, DetectedFeatures> detected;
  {
    const StageLog::Scope scope(stages, "features");
    auto result = DetectFeatures(*scene, options.features, context);
    if (!result) return tl::unexpected<Error>(result.error());
    detected = std::move(*result);
  }
  std::map<ViewPair, PairMatches> matches;
  {
    const StageLog::Scope scope(stages, "matching");
    auto result = MatchFeatures(detected, *pairs, options.matching, context);
    if (!result) return tl::unexpected<Error>(result.error());
    matches = std::move(*result);
  }
  for (auto& [view, features] : detected) {
    scene->features[view] = std::move(features.features);
  }
  detected.clear();
  const StageLog::Scope scope(stages, "relative poses");
  auto reports =
      EstimateRelativePoses(scene, matches, options.relative_poses, context);
  if (reports) KeepMatchedFeatures(scene);
  return reports;
}

}  // namespace lowlap
