#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"

namespace lowlap {

/// What became of a track, as TriangulationSummary counts it.
enum class LandmarkStatus {
  kLandmark,
  kTooFewViews,
  kInconsistent,
  kBehindCamera,
  kUncertain,
  kImplausible,
};

/// A feature that may show a landmark.
struct TrackCandidate {
  int view = -1;  // index into CameraSet::views
  FeatureIndex feature = kInvalidId;
  bool used = false;  // belongs to the landmark
};

/// A track in views with poses, and what became of it.
template <class TrackId, class Candidate>
struct TrackState {
  TrackId id = kInvalidId;
  std::vector<Candidate> candidates;  // sorted by view
  LandmarkStatus status = LandmarkStatus::kTooFewViews;

  bool IsLandmark() const { return status == LandmarkStatus::kLandmark; }
  std::size_t UsedCount() const {
    return static_cast<std::size_t>(
        std::count_if(candidates.begin(), candidates.end(),
                      [](const Candidate& c) { return c.used; }));
  }
  /// Number of poses that the candidates in use come from.
  std::size_t PoseCount(const CameraSet& cameras) const {
    std::set<int> poses;
    for (const Candidate& candidate : candidates) {
      if (candidate.used) poses.insert(cameras.views[candidate.view].pose);
    }
    return poses.size();
  }
  std::vector<char> Used() const {
    std::vector<char> used;
    for (const Candidate& candidate : candidates)
      used.push_back(candidate.used);
    return used;
  }
  void Use(const std::vector<char>& used) {
    for (std::size_t n = 0; n < candidates.size(); ++n) {
      candidates[n].used = used[n] != 0;
    }
  }
  /// There is no landmark, for this reason.
  void Abandon(LandmarkStatus reason) {
    for (Candidate& candidate : candidates) candidate.used = false;
    status = reason;
  }
};

}  // namespace lowlap
