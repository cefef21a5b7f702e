#include "lowlap/adjustment/internal/structure/prediction_evidence.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {
namespace {

constexpr int kSampleSize = 6;
constexpr double kMinThresholdPx = 0.1;
constexpr double kMaxThresholdPx = 16;

std::optional<PointTrackState> Refined(const CameraSet& cameras,
                                       PointTrackState track) {
  const auto estimate = EstimateFromPixels(cameras, track);
  if (!estimate) return std::nullopt;
  track.position = estimate->position;
  return track;
}

std::optional<LineTrackState> Refined(const CameraSet& cameras,
                                      LineTrackState track) {
  const auto estimate = EstimateFromSegments(cameras, track);
  if (!estimate) return std::nullopt;
  track.point = estimate->point;
  track.direction = estimate->direction;
  return track;
}

// Of the candidates of pose `v`, where the landmark rests on the others of
// `poses`, and at least two, without it.
template <class Track>
double PredictedErrorPx(const CameraSet& cameras, const std::vector<int>& poses,
                        int v, Track track) {
  if (!track.IsLandmark()) return kInfinity;
  std::set<int> rests_on;
  for (auto& candidate : track.candidates) {
    const int pose = cameras.views[candidate.view].pose;
    candidate.used = candidate.used && pose != v;
    if (candidate.used) rests_on.insert(pose);
  }
  const auto is_missing = [&](int pose) {
    return pose != v && rests_on.count(pose) == 0;
  };
  if (rests_on.size() < 2 ||
      std::any_of(poses.begin(), poses.end(), is_missing)) {
    return kInfinity;
  }
  const std::optional<Track> refined = Refined(cameras, std::move(track));
  if (!refined) return kInfinity;
  double worst_px = 0;
  for (const auto& candidate : refined->candidates) {
    if (cameras.views[candidate.view].pose != v) continue;
    worst_px = std::max(worst_px, ErrorPx(cameras, *refined, candidate));
  }
  return worst_px;
}

// The tracks of one kind with candidates in three poses or more, by pose.
template <class Track>
class SharedTracks {
 public:
  SharedTracks(const CameraSet& cameras, std::vector<Track> tracks)
      : cameras_(cameras),
        tracks_(std::move(tracks)),
        of_pose_(cameras.poses.size()) {
    for (std::size_t n = 0; n < tracks_.size(); ++n) {
      std::set<int> poses;
      for (const auto& candidate : tracks_[n].candidates) {
        poses.insert(cameras.views[candidate.view].pose);
      }
      if (poses.size() < 3) continue;
      for (const int pose : poses) of_pose_[pose].push_back(n);
    }
  }

  void AddPredictedSquares(const std::vector<int>& poses, int v,
                           std::vector<float>* squared_px) const {
    std::vector<std::size_t> shared = of_pose_[v];
    for (const int pose : poses) {
      std::vector<std::size_t> both;
      std::set_intersection(shared.begin(), shared.end(),
                            of_pose_[pose].begin(), of_pose_[pose].end(),
                            std::back_inserter(both));
      shared = std::move(both);
    }
    for (const std::size_t n : shared) {
      const double error_px = PredictedErrorPx(cameras_, poses, v, tracks_[n]);
      squared_px->push_back(static_cast<float>(error_px * error_px));
    }
  }

 private:
  const CameraSet& cameras_;
  const std::vector<Track> tracks_;
  std::vector<std::vector<std::size_t>> of_pose_;  // sorted
};

// Copies of a pattern have a structure of their own, which predicts them well.
template <class Track>
std::vector<Track> WithoutRepeats(
    const Scene& scene, const CameraSet& cameras,
    std::vector<FeatureIndex> ViewFeatures::*repeated,
    std::vector<Track> tracks) {
  const auto repeats = [&](const auto& candidate) {
    const ViewId view = cameras.views[candidate.view].id;
    const std::vector<FeatureIndex>& features =
        scene.features.at(view).*repeated;
    return std::binary_search(features.begin(), features.end(),
                              candidate.feature);
  };
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) {
                                return std::any_of(track.candidates.begin(),
                                                   track.candidates.end(),
                                                   repeats);
                              }),
               tracks.end());
  return tracks;
}

bool IsMajority(std::ptrdiff_t count, const std::vector<float>& all) {
  return 2 * static_cast<std::size_t>(count) > all.size();
}

class Structure {
 public:
  explicit Structure(const Scene& scene)
      : cameras_(scene),
        points_(cameras_,
                WithoutRepeats(scene, cameras_, &ViewFeatures::repeated_points,
                               LoadPoints(scene, cameras_))),
        lines_(cameras_,
               WithoutRepeats(scene, cameras_, &ViewFeatures::repeated_segments,
                              LoadLines(scene, cameras_, false))) {}

  struct Evidence {
    double log10_nfa = 0;
    bool is_contradicted = true;
  };

  // The ends are the first and the last. nullopt: a view has no pose.
  std::optional<Evidence> EvidenceOf(const std::vector<ViewId>& views) const {
    std::vector<int> poses;
    for (const ViewId view : views) {
      const int index = cameras_.Find(view);
      if (index < 0) return std::nullopt;
      poses.push_back(cameras_.views[index].pose);
    }
    Evidence evidence;
    for (const int end : {poses.front(), poses.back()}) {
      std::vector<float> squared_px;
      points_.AddPredictedSquares(poses, end, &squared_px);
      lines_.AddPredictedSquares(poses, end, &squared_px);
      const double log10_nfa = std::log10(2.0) + Log10Nfa(squared_px);
      evidence.log10_nfa = std::min(evidence.log10_nfa, log10_nfa);
      evidence.is_contradicted =
          evidence.is_contradicted && squared_px.size() > kSampleSize &&
          !IsMajority(std::count_if(squared_px.begin(), squared_px.end(),
                                    [](float squared) {
                                      return squared <=
                                             kMaxThresholdPx * kMaxThresholdPx;
                                    }),
                      squared_px);
    }
    return evidence;
  }

 private:
  double Log10Nfa(const std::vector<float>& squared_px) const {
    if (squared_px.size() <= kSampleSize) return 0;
    const AContrarioLadder ladder(static_cast<int>(squared_px.size()),
                                  kSampleSize, 1, cameras_.PointToLine(),
                                  kMinThresholdPx, kMaxThresholdPx);
    const AContrarioScore score = ladder.Score(squared_px);
    return IsMajority(score.num_inliers, squared_px) ? score.log10_nfa : 0;
  }

  const CameraSet cameras_;
  const SharedTracks<PointTrackState> points_;
  const SharedTracks<LineTrackState> lines_;
};

}  // namespace

PredictionEvidence FindPredictionEvidence(
    const Scene& scene, const std::vector<ViewPair>& pairs,
    const std::vector<ViewTriplet>& triplets) {
  PredictionEvidence evidence;
  if (pairs.empty() && triplets.empty()) return evidence;
  const Structure structure(scene);
  for (const ViewPair& views : pairs) {
    const auto of_pair = structure.EvidenceOf({views.first, views.second});
    if (!of_pair) continue;
    evidence.pairs[views] = of_pair->log10_nfa;
    if (of_pair->is_contradicted) evidence.contradicted.push_back(views);
  }
  for (const ViewTriplet& views : triplets) {
    const auto of_triplet =
        structure.EvidenceOf({views.first, views.middle, views.last});
    if (of_triplet) evidence.triplets[views] = of_triplet->log10_nfa;
  }
  return evidence;
}

}  // namespace lowlap
