#include "lowlap/adjustment/internal/rounds/kind_statistics.h"

#include <cmath>
#include <set>

#include "lowlap/adjustment/internal/rounds/pairs.h"

namespace lowlap {
namespace {

class RootMeanSquare {
 public:
  void Add(double error) {
    if (!std::isfinite(error)) return;
    sum_ += error * error;
    ++count_;
  }
  std::optional<double> Value() const {
    if (count_ == 0) return std::nullopt;
    return std::sqrt(sum_ / count_);
  }

 private:
  double sum_ = 0;
  double count_ = 0;
};

template <class Track>
std::optional<double> Rmse(const CameraSet& cameras,
                           const std::vector<Track>& tracks) {
  RootMeanSquare mean;
  for (const Track& track : tracks) {
    if (!track.IsLandmark()) continue;
    for (const auto& candidate : track.candidates) {
      if (candidate.used) mean.Add(DistancePx(cameras, track, candidate));
    }
  }
  return mean.Value();
}

template <class Track>
void CountTracks(const std::vector<Track>& tracks, KindAdjustment* summary) {
  for (const Track& track : tracks) {
    const std::size_t used = track.IsLandmark() ? track.UsedCount() : 0;
    if (track.IsLandmark()) ++summary->landmarks;
    summary->observations_used += used;
    summary->observations_dropped += track.candidates.size() - used;
  }
}

}  // namespace

KindRmse ComputeRmse(const CameraSet& cameras, const StructureState& state,
                     AdjustedCoplanarResidual residual) {
  RootMeanSquare coplanar;
  for (const PairState& pair : state.pairs) {
    if (!pair.used || !state.HasLines(pair)) continue;
    coplanar.Add(PairErrorPx(cameras, state, pair, residual));
  }
  return {Rmse(cameras, state.points), Rmse(cameras, state.lines),
          coplanar.Value()};
}

void CountObservations(const std::vector<PointTrackState>& points,
                       KindAdjustment* summary) {
  CountTracks(points, summary);
}

void CountObservations(const std::vector<LineTrackState>& lines,
                       KindAdjustment* summary) {
  CountTracks(lines, summary);
}

void CountPairs(const std::vector<PairState>& pairs, std::size_t input_pairs,
                KindAdjustment* summary) {
  std::set<int> linked;
  for (const PairState& pair : pairs) {
    if (!pair.used) {
      summary->observations_surplus += pair.consistent ? 1 : 0;
      continue;
    }
    ++summary->observations_used;
    linked.insert(pair.first);
    linked.insert(pair.second);
  }
  summary->landmarks = linked.size();
  summary->observations_dropped =
      input_pairs - summary->observations_used - summary->observations_surplus;
}

}  // namespace lowlap
