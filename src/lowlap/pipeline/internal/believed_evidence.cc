#include "lowlap/pipeline/internal/believed_evidence.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "lowlap/core/internal/union_find.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

using Matches = std::vector<FeatureMatch> RelativePose::*;

// What joins two observations of a track.
class Links {
 public:
  // `matches`: point_inliers or line_inliers.
  Links(const std::vector<ViewPair>& left_out,
        const std::map<ViewPair, RelativePose>& poses, Matches matches)
      : poses_(poses), matches_(matches) {
    for (const ViewPair& views : left_out) {
      left_out_[views.first].insert(views.second);
      left_out_[views.second].insert(views.first);
    }
    are_matches_known_ = std::any_of(
        poses.begin(), poses.end(),
        [&](const auto& entry) { return !(entry.second.*matches).empty(); });
  }

  // The views whose relative poses with this one were left out.
  const std::set<ViewId>& LeftOutWith(ViewId view) const {
    static const std::set<ViewId> kNone;
    const auto partners = left_out_.find(view);
    return partners == left_out_.end() ? kNone : partners->second;
  }

  // Whether a relative pose that was not left out matches the two; where
  // nobody knows matches, any may.
  bool AreJoined(const FeatureRef& a, const FeatureRef& b) {
    if (a.view == b.view) return true;
    if (LeftOutWith(a.view).count(b.view) > 0) return false;
    if (!are_matches_known_) return true;
    return a.view < b.view ? IsMatch(a, b) : IsMatch(b, a);
  }

 private:
  bool IsMatch(const FeatureRef& first, const FeatureRef& second) {
    const ViewPair views{first.view, second.view};
    const auto [entry, is_new] = sorted_.try_emplace(views);
    std::vector<FeatureMatch>& matches = entry->second;
    if (is_new) {
      const auto pose = poses_.find(views);
      if (pose != poses_.end()) matches = pose->second.*matches_;
      std::sort(matches.begin(), matches.end());
    }
    return std::binary_search(matches.begin(), matches.end(),
                              FeatureMatch{first.feature, second.feature});
  }

  const std::map<ViewPair, RelativePose>& poses_;
  Matches matches_;
  bool are_matches_known_ = false;
  std::map<ViewId, std::set<ViewId>> left_out_;
  std::map<ViewPair, std::vector<FeatureMatch>> sorted_;  // of those asked for
};

bool Sees(const Track& track, ViewId view) {
  return std::any_of(
      track.begin(), track.end(),
      [&](const FeatureRef& observation) { return observation.view == view; });
}

// Whether any two views of the track were left out: of most tracks, none.
bool MayChange(const Track& track, const Links& links) {
  for (const FeatureRef& observation : track) {
    for (const ViewId partner : links.LeftOutWith(observation.view)) {
      if (Sees(track, partner)) return true;
    }
  }
  return false;
}

Track BelievedPart(const Track& track, Links* links) {
  UnionFind joined(track.size());
  for (std::size_t a = 0; a < track.size(); ++a) {
    for (std::size_t b = a + 1; b < track.size(); ++b) {
      if (links->AreJoined(track[a], track[b])) joined.Union(a, b);
    }
  }
  const std::vector<std::size_t> labels = joined.Labels();
  std::vector<Track> parts(1 + *std::max_element(labels.begin(), labels.end()));
  for (std::size_t n = 0; n < track.size(); ++n) {
    parts[labels[n]].push_back(track[n]);
  }
  return *std::max_element(
      parts.begin(), parts.end(),
      [](const Track& a, const Track& b) { return a.size() < b.size(); });
}

bool HasTwoViews(const Track& track) {
  return track.front().view != track.back().view;
}

// Moves what changes to `changed`.
template <class Tracks>
void Reduce(Links links, Tracks* tracks, Tracks* changed) {
  for (auto entry = tracks->begin(); entry != tracks->end();) {
    Track& track = entry->second;
    Track believed;
    if (MayChange(track, links)) believed = BelievedPart(track, &links);
    if (believed.empty() || believed.size() == track.size()) {
      ++entry;
      continue;
    }
    changed->emplace(entry->first, std::move(track));
    if (HasTwoViews(believed)) {
      track = std::move(believed);
      ++entry;
    } else {
      entry = tracks->erase(entry);
    }
  }
}

template <class Tracks>
void Restore(Tracks* changed, Tracks* tracks) {
  for (auto& [id, track] : *changed) (*tracks)[id] = std::move(track);
}

}  // namespace

std::vector<ViewPair> FalsePairs(const PoseSummary& summary) {
  std::vector<ViewPair> pairs;
  for (const OutlierEdge& edge : summary.outlier_edges) {
    if (edge.IsFalse()) pairs.push_back(edge.views);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

BelievedEvidence::BelievedEvidence(const std::vector<ViewPair>& left_out,
                                   Scene* scene)
    : scene_(scene) {
  const auto& poses = scene->relative_poses;
  Reduce(Links(left_out, poses, &RelativePose::point_inliers),
         &scene->point_tracks, &changed_points_);
  Reduce(Links(left_out, poses, &RelativePose::line_inliers),
         &scene->line_tracks, &changed_lines_);
  for (const ViewPair& views : left_out) {
    auto pose = scene->relative_poses.extract(views);
    if (!pose.empty()) left_out_poses_.insert(std::move(pose));
  }
  scale_ratios_ = scene->scale_ratios;
  const auto is_left_out = [&](ViewId a, ViewId b) {
    return left_out_poses_.count(OrderedPair(a, b)) > 0;
  };
  scene->scale_ratios.erase(
      std::remove_if(scene->scale_ratios.begin(), scene->scale_ratios.end(),
                     [&](const ScaleRatio& ratio) {
                       const ViewTriplet& views = ratio.views;
                       return is_left_out(views.first, views.middle) ||
                              is_left_out(views.middle, views.last);
                     }),
      scene->scale_ratios.end());
}

BelievedEvidence::~BelievedEvidence() {
  Restore(&changed_points_, &scene_->point_tracks);
  Restore(&changed_lines_, &scene_->line_tracks);
  scene_->relative_poses.merge(left_out_poses_);
  scene_->scale_ratios = std::move(scale_ratios_);
}

}  // namespace lowlap
