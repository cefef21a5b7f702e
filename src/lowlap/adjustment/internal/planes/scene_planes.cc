#include "lowlap/adjustment/internal/planes/scene_planes.h"

#include <algorithm>
#include <cmath>

#include "lowlap/adjustment/internal/planes/plane_fit.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/robust/internal/nfa.h"

namespace lowlap {
namespace {

constexpr int kNumThicknesses = 9;
constexpr double kThickest = 1.0 / 128;  // of the scene's reach
constexpr double kMemberReach = 3;       // deviations

struct Hypothesis {
  Plane plane;
  std::size_t first = 0;  // indices of the free landmarks of its lines
  std::size_t second = 0;
};

std::vector<Hypothesis> HypothesesOfPairs(
    const std::vector<FreeLandmark>& landmarks, const StructureState& state) {
  std::vector<int> by_line(state.lines.size(), -1);
  for (std::size_t n = 0; n < landmarks.size(); ++n) {
    if (landmarks[n].is_line) by_line[landmarks[n].index] = static_cast<int>(n);
  }
  std::vector<Hypothesis> hypotheses;
  for (const PairState& pair : state.pairs) {
    if (by_line[pair.first] < 0 || by_line[pair.second] < 0) continue;
    Hypothesis hypothesis;
    hypothesis.first = static_cast<std::size_t>(by_line[pair.first]);
    hypothesis.second = static_cast<std::size_t>(by_line[pair.second]);
    const FreeLandmark& a = landmarks[hypothesis.first];
    const FreeLandmark& b = landmarks[hypothesis.second];
    const Vec3 normal = (a.places[1].point - a.places[0].point)
                            .cross(b.places[1].point - b.places[0].point);
    if (!(normal.norm() > 0)) continue;
    Plane& plane = hypothesis.plane;
    plane.normal = normal.normalized();
    plane.offset = 0.5 * plane.normal.dot(a.Center() + b.Center());
    hypotheses.push_back(hypothesis);
  }
  return hypotheses;
}

// How far the scene reaches: the middle nine tenths of the distances, made up
// to all.
double ReachOf(std::vector<double> distances) {
  const auto at = [&](std::size_t n) {
    std::nth_element(distances.begin(),
                     distances.begin() + static_cast<std::ptrdiff_t>(n),
                     distances.end());
    return distances[n];
  };
  const std::size_t tail = distances.size() / 20;
  const double low = at(tail);
  return (at(distances.size() - 1 - tail) - low) / 0.9;
}

struct PlaneScore {
  double log10_nfa = 0;
  double thickness = 0;

  bool operator<(const PlaneScore& other) const {
    return log10_nfa < other.log10_nfa;
  }
};

class PlaneFinder {
 public:
  PlaneFinder(const std::vector<FreeLandmark>& landmarks,
              const StructureState& state)
      : landmarks_(landmarks),
        hypotheses_(HypothesesOfPairs(landmarks, state)),
        taken_(landmarks.size(), 0),
        factorials_(static_cast<int>(landmarks.size())),
        log10_tests_(std::log10(
            std::max<std::size_t>(1, hypotheses_.size() * kNumThicknesses))) {}

  // Members only become fewer, and a score only worse: one that is computed
  // anew and still the least is the least of all.
  Result<std::vector<PlaneState>> Run(const RunContext& context) {
    std::vector<PlaneScore> scores(hypotheses_.size());
    LOWLAP_RETURN_IF_ERROR(
        ParallelFor(context, {}, scores.size(),
                    [&](std::size_t n) { scores[n] = ScoreOf(n); }));
    std::vector<PlaneState> planes;
    while (true) {
      const auto best = std::min_element(scores.begin(), scores.end());
      if (best == scores.end() || !(best->log10_nfa < 0)) break;
      const auto n = static_cast<std::size_t>(best - scores.begin());
      const PlaneScore again = ScoreOf(n);
      if (again.log10_nfa > best->log10_nfa) {
        *best = again;
        continue;
      }
      *best = {};
      PlaneState plane;
      if (Fit(hypotheses_[n].plane, again, &plane)) {
        planes.push_back(std::move(plane));
      }
    }
    return planes;
  }

 private:
  PlaneScore ScoreOf(std::size_t hypothesis) const {
    const auto& [plane, first, second] = hypotheses_[hypothesis];
    PlaneScore best;
    if (taken_[first] || taken_[second]) return best;
    std::vector<Across> across;
    std::vector<double> distances;
    for (std::size_t n = 0; n < landmarks_.size(); ++n) {
      const Across one = AcrossPlane(landmarks_[n], plane);
      distances.push_back(one.distance);
      if (!taken_[n]) across.push_back(one);
    }
    const double reach = ReachOf(std::move(distances));
    double thickness = kThickest * reach;
    for (int step = 0; step < kNumThicknesses; ++step, thickness *= 0.5) {
      int n = 0, k = 0;
      for (const Across& one : across) {
        if (one.stddev > thickness) continue;
        ++n;
        k += std::abs(one.distance) <= 2 * thickness ? 1 : 0;
      }
      if (k <= 2) continue;
      const double log10_nfa =
          log10_tests_ + Log10ChanceOfSet(factorials_, n - 2, k - 2,
                                          std::log10(4 * thickness / reach));
      if (log10_nfa < best.log10_nfa) best = {log10_nfa, thickness};
    }
    return best;
  }

  // Fits the plane to its members and takes them; false if too few are left.
  bool Fit(Plane plane, const PlaneScore& score, PlaneState* state) {
    double thickness = score.thickness;
    std::vector<const FreeLandmark*> members;
    constexpr int kRounds = 5;
    for (int round = 0; round < kRounds; ++round) {
      members.clear();
      for (std::size_t n = 0; n < landmarks_.size(); ++n) {
        if (taken_[n]) continue;
        const Across across = AcrossPlane(landmarks_[n], plane);
        if (across.stddev <= score.thickness &&
            std::abs(across.distance) <=
                kMemberReach * std::hypot(across.stddev, thickness)) {
          members.push_back(&landmarks_[n]);
        }
      }
      if (members.size() < 4) return false;  // any three are on one
      plane = FitPlane(members, plane, thickness);
      thickness = std::min(score.thickness, PlaneThickness(members, plane));
    }
    state->normal = plane.normal;
    for (const FreeLandmark* member : members) {
      state->anchor += member->Center();
      (member->is_line ? state->lines : state->points).push_back(member->index);
      taken_[member - landmarks_.data()] = 1;
    }
    state->anchor /= static_cast<double>(members.size());
    state->offset = plane.offset - plane.normal.dot(state->anchor);
    state->thickness = thickness;
    state->log10_nfa = score.log10_nfa;
    return true;
  }

  const std::vector<FreeLandmark>& landmarks_;
  const std::vector<Hypothesis> hypotheses_;
  std::vector<char> taken_;
  LogFactorials factorials_;
  double log10_tests_;
};

}  // namespace

Result<std::vector<PlaneState>> FindPlanes(
    const std::vector<FreeLandmark>& landmarks, const StructureState& state,
    const RunContext& context) {
  if (landmarks.size() < 4) return std::vector<PlaneState>();
  return PlaneFinder(landmarks, state).Run(context);
}

}  // namespace lowlap
