#include "lowlap/averaging/strategies/internal/track_groups.h"

#include <algorithm>
#include <utility>

#include "lowlap/averaging/internal/track_rays.h"

namespace lowlap {
namespace {

// Two views and how many points they share.
struct Seed {
  std::pair<std::size_t, std::size_t> views;
  std::size_t num_shared;
};

// Those that share enough, by views.
std::vector<Seed> FindSeeds(
    const std::vector<std::vector<std::size_t>>& tracks_of_view,
    const std::vector<TrackRays>& tracks, std::size_t min_points) {
  const std::size_t num_views = tracks_of_view.size();
  std::vector<Seed> seeds;
  std::vector<std::size_t> count(num_views, 0), met;
  for (std::size_t view = 0; view < num_views; ++view) {
    for (const std::size_t t : tracks_of_view[view]) {
      for (const RayObservation& seen : tracks[t].observations) {
        if (seen.view > view && ++count[seen.view] == 1) {
          met.push_back(seen.view);
        }
      }
    }
    std::sort(met.begin(), met.end());
    for (const std::size_t other : met) {
      if (count[other] >= min_points) {
        seeds.push_back({{view, other}, count[other]});
      }
      count[other] = 0;
    }
    met.clear();
  }
  return seeds;
}

/// Grows one group after the other; what a group left is told by its stamp.
class GroupGrower {
 public:
  GroupGrower(const std::vector<std::vector<std::size_t>>& tracks_of_view,
              const std::vector<TrackRays>& tracks, std::size_t min_points)
      : tracks_of_view_(tracks_of_view),
        tracks_(tracks),
        min_points_(min_points),
        views_(tracks_of_view.size()),
        sightings_(tracks.size()) {}

  std::vector<std::size_t> Grow(std::size_t first, std::size_t second) {
    ++stamp_;
    group_ = {first, second};
    Fresh(first).is_in = Fresh(second).is_in = true;
    for (std::size_t n = 0; n < group_.size(); ++n) Visit(group_[n]);
    std::sort(group_.begin(), group_.end());
    return std::move(group_);
  }

 private:
  struct ViewState {
    std::size_t stamp = 0;
    bool is_in = false;
    std::size_t num_known = 0;
  };
  struct Sightings {
    std::size_t stamp = 0;
    int count = 0;
  };

  ViewState& Fresh(std::size_t view) {
    if (views_[view].stamp != stamp_) views_[view] = {stamp_, false, 0};
    return views_[view];
  }

  void Visit(std::size_t view) {
    for (const std::size_t t : tracks_of_view_[view]) {
      if (sightings_[t].stamp != stamp_) sightings_[t] = {stamp_, 0};
      if (++sightings_[t].count != 2) continue;
      for (const RayObservation& seen : tracks_[t].observations) {
        ViewState& state = Fresh(seen.view);
        if (++state.num_known >= min_points_ && !state.is_in) {
          state.is_in = true;
          group_.push_back(seen.view);
        }
      }
    }
  }

  const std::vector<std::vector<std::size_t>>& tracks_of_view_;
  const std::vector<TrackRays>& tracks_;
  std::size_t min_points_;
  std::vector<ViewState> views_;
  std::vector<Sightings> sightings_;
  std::vector<std::size_t> group_;
  std::size_t stamp_ = 0;
};

}  // namespace

std::vector<std::vector<std::size_t>> GroupViewsByTracks(
    std::size_t num_views, const std::vector<TrackRays>& tracks,
    std::size_t min_views, std::size_t min_points) {
  const auto tracks_of_view = TracksOfViews(tracks, num_views, min_views);
  std::vector<Seed> seeds = FindSeeds(tracks_of_view, tracks, min_points);
  std::stable_sort(
      seeds.begin(), seeds.end(),
      [](const Seed& a, const Seed& b) { return a.num_shared > b.num_shared; });

  GroupGrower grower(tracks_of_view, tracks, min_points);
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::vector<std::size_t>> groups_of_view(num_views);
  for (const Seed& seed : seeds) {
    const auto& of_first = groups_of_view[seed.views.first];
    const auto& of_second = groups_of_view[seed.views.second];
    const bool is_grouped =
        std::any_of(of_first.begin(), of_first.end(), [&](std::size_t group) {
          return std::count(of_second.begin(), of_second.end(), group) > 0;
        });
    if (is_grouped) continue;
    std::vector<std::size_t> views =
        grower.Grow(seed.views.first, seed.views.second);
    for (const std::size_t view : views) {
      groups_of_view[view].push_back(groups.size());
    }
    groups.push_back(std::move(views));
  }
  std::stable_sort(
      groups.begin(), groups.end(),
      [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

}  // namespace lowlap
