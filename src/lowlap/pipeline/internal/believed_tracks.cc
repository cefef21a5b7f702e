#include "lowlap/pipeline/internal/believed_tracks.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

using Partners = std::map<ViewId, std::set<ViewId>>;

bool AreLeftOut(const Partners& left_out, ViewId a, ViewId b) {
  const auto partners = left_out.find(a);
  return partners != left_out.end() && partners->second.count(b) > 0;
}

bool Sees(const Track& track, ViewId view) {
  return std::any_of(
      track.begin(), track.end(),
      [&](const FeatureRef& observation) { return observation.view == view; });
}

// Whether any two views of the track were left out: of most tracks, none.
bool MayChange(const Track& track, const Partners& left_out) {
  for (const FeatureRef& observation : track) {
    const auto partners = left_out.find(observation.view);
    if (partners == left_out.end()) continue;
    for (const ViewId partner : partners->second) {
      if (Sees(track, partner)) return true;
    }
  }
  return false;
}

Track BelievedPart(const Track& track, const Partners& left_out) {
  UnionFind joined(track.size());
  for (std::size_t a = 0; a < track.size(); ++a) {
    for (std::size_t b = a + 1; b < track.size(); ++b) {
      if (!AreLeftOut(left_out, track[a].view, track[b].view)) {
        joined.Union(a, b);
      }
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
void Reduce(const Partners& left_out, Tracks* tracks, Tracks* changed) {
  for (auto entry = tracks->begin(); entry != tracks->end();) {
    Track& track = entry->second;
    Track believed;
    if (MayChange(track, left_out)) believed = BelievedPart(track, left_out);
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

BelievedTracks::BelievedTracks(const std::vector<ViewPair>& left_out,
                               Scene* scene)
    : scene_(scene) {
  Partners partners;
  for (const ViewPair& views : left_out) {
    partners[views.first].insert(views.second);
    partners[views.second].insert(views.first);
  }
  Reduce(partners, &scene->point_tracks, &changed_points_);
  Reduce(partners, &scene->line_tracks, &changed_lines_);
}

BelievedTracks::~BelievedTracks() {
  Restore(&changed_points_, &scene_->point_tracks);
  Restore(&changed_lines_, &scene_->line_tracks);
}

}  // namespace lowlap
