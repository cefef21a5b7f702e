#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "lowlap/averaging/rotations/internal/rotation_averaging.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

/// Choices of motions that are tried at most at a time.
constexpr std::size_t kMaxChoices = 128;

using Choice = std::map<ViewPair, std::size_t>;  // the motion of a pair

std::vector<ViewPair> UndecidedPairs(const Scene& scene) {
  std::vector<ViewPair> pairs;
  for (const auto& [views, pose] : scene.relative_poses) {
    if (!pose.alternatives.empty()) pairs.push_back(views);
  }
  return pairs;
}

std::vector<Choice> AllChoices(const Scene& scene,
                               const std::vector<ViewPair>& pairs) {
  std::vector<Choice> choices(1);
  for (const ViewPair& views : pairs) {
    std::vector<Choice> longer;
    for (const Choice& choice : choices) {
      for (std::size_t n = 0; n < NumHypotheses(scene.relative_poses.at(views));
           ++n) {
        longer.push_back(choice);
        longer.back()[views] = n;
      }
    }
    choices = std::move(longer);
  }
  return choices;
}

// All choices for the undecided pairs, or those of one pair at a time if there
// are too many of them.
std::vector<Choice> ChoicesToTry(const Scene& scene) {
  const std::vector<ViewPair> pairs = UndecidedPairs(scene);
  std::size_t count = 1;
  for (const ViewPair& views : pairs) {
    count *= NumHypotheses(scene.relative_poses.at(views));
    if (count > kMaxChoices) break;
  }
  if (count <= kMaxChoices) return AllChoices(scene, pairs);
  std::vector<Choice> choices;
  for (const ViewPair& views : pairs) {
    for (Choice& choice : AllChoices(scene, {views})) {
      choices.push_back(std::move(choice));
    }
  }
  return choices;
}

class ChoiceCosts {
 public:
  ChoiceCosts(const Scene& scene, const PoseOptions& options,
              std::uint64_t seed)
      : options_(options.rotation) {
    options_.seed = seed;
    const double floor_rad =
        RadFromDeg(options.least_false_deg) / options.outlier_reach;
    for (const auto& [views, pose] : scene.relative_poses) {
      for (std::size_t n = 0; n < NumHypotheses(pose); ++n) {
        const RelativePose motion = WithHypothesis(pose, n);
        RotationMeasurement m;
        m.first = index_.emplace(views.first, index_.size()).first->second;
        m.second = index_.emplace(views.second, index_.size()).first->second;
        m.second_from_first = motion.rotation;
        m.stddev_rad = std::hypot(RotationStddev(motion), floor_rad);
        m.cost = motion.log10_nfa;
        motions_[views].push_back(m);
      }
    }
  }

  /// Pairs that `choice` does not name take part with all their motions, and
  /// cost what the best of them does.
  Result<double> Of(const Choice& choice) const {
    std::vector<RotationMeasurement> measurements;
    std::vector<std::size_t> num_motions;  // of each pair
    for (const auto& [views, motions] : motions_) {
      const auto chosen = choice.find(views);
      if (chosen != choice.end()) {
        num_motions.push_back(1);
        measurements.push_back(motions[chosen->second]);
      } else {
        num_motions.push_back(motions.size());
        measurements.insert(measurements.end(), motions.begin(), motions.end());
      }
    }
    const auto averaged =
        AverageRotations(index_.size(), measurements, options_);
    if (!averaged) return tl::unexpected<Error>(averaged.error());
    double cost = 0;
    std::size_t e = 0;
    for (const std::size_t count : num_motions) {
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t end = e + count; e < end; ++e) {
        least = std::min(
            least, averaged->residuals_rad[e] / measurements[e].stddev_rad);
      }
      cost += std::log1p(least * least / 3);
    }
    return cost;
  }

 private:
  RotationAveragingOptions options_;
  std::map<ViewId, std::size_t> index_;
  std::map<ViewPair, std::vector<RotationMeasurement>> motions_;
};

// The least cost of any choice with each motion of each pair in them.
Result<std::map<ViewPair, std::vector<double>>> LeastCosts(
    const Scene& scene, const std::vector<Choice>& choices,
    const PoseOptions& options, const RunContext& context) {
  const ChoiceCosts costs(scene, options, context.seed);
  std::vector<Result<double>> results(choices.size());
  const Status done =
      ParallelFor(context, "ambiguous planes", choices.size(),
                  [&](std::size_t n) { results[n] = costs.Of(choices[n]); });
  if (!done) return tl::unexpected<Error>(done.error());
  std::map<ViewPair, std::vector<double>> least;
  for (std::size_t n = 0; n < choices.size(); ++n) {
    if (!results[n]) return tl::unexpected<Error>(results[n].error());
    for (const auto& [views, motion] : choices[n]) {
      std::vector<double>& of_pair = least[views];
      of_pair.resize(NumHypotheses(scene.relative_poses.at(views)),
                     std::numeric_limits<double>::infinity());
      of_pair[motion] = std::min(of_pair[motion], *results[n]);
    }
  }
  return least;
}

}  // namespace

const char* HypothesisGroundsName(HypothesisGrounds grounds) {
  switch (grounds) {
    case HypothesisGrounds::kNone:
      return "none";
    case HypothesisGrounds::kCycles:
      return "cycles";
    case HypothesisGrounds::kTriplets:
      return "triplets";
    case HypothesisGrounds::kStructure:
      return "structure";
  }
  return "";
}

std::size_t NumHypotheses(const RelativePose& pose) {
  return 1 + pose.alternatives.size();
}

RelativePose WithHypothesis(const RelativePose& pose, std::size_t n) {
  return pose.WithMotion(n == 0 ? pose.AsAlternative()
                                : pose.alternatives[n - 1]);
}

double MotionSpread(const RelativePose& pose) {
  double spread_rad = RotationSpread(pose);
  for (const AlternativeMotion& other : pose.alternatives) {
    spread_rad =
        std::max(spread_rad, AngleBetween(pose.direction, other.direction));
  }
  return spread_rad;
}

double RotationSpread(const RelativePose& pose) {
  double spread_rad = 0;
  for (const AlternativeMotion& other : pose.alternatives) {
    spread_rad = std::max(spread_rad,
                          RotationAngleBetween(pose.rotation, other.rotation));
  }
  return spread_rad;
}

HypothesisDecision ChooseHypothesis(const std::vector<double>& costs,
                                    double margin, HypothesisGrounds grounds,
                                    RelativePose* pose) {
  const auto best = std::min_element(costs.begin(), costs.end());
  double next = std::numeric_limits<double>::infinity();
  for (auto cost = costs.begin(); cost != costs.end(); ++cost) {
    if (cost != best) next = std::min(next, *cost);
  }
  HypothesisDecision decision;
  decision.views = pose->views;
  decision.margin = next - *best;
  if (!(decision.margin >= margin)) return decision;
  decision.grounds = grounds;
  decision.replaced = best != costs.begin();
  *pose = WithHypothesis(*pose, static_cast<std::size_t>(best - costs.begin()));
  return decision;
}

Result<std::vector<HypothesisDecision>> DecideHypothesesByCycles(
    Scene* scene, const PoseOptions& options, const RunContext& context) {
  const double margin =
      std::log1p(options.outlier_reach * options.outlier_reach);
  std::vector<HypothesisDecision> decisions;
  std::map<ViewPair, RelativePose> undecided;
  for (const ViewPair& views : UndecidedPairs(*scene)) {
    undecided.emplace(views, scene->relative_poses.at(views));
  }
  for (bool changed = true; changed && !UndecidedPairs(*scene).empty();) {
    changed = false;
    const auto costs =
        LeastCosts(*scene, ChoicesToTry(*scene), options, context);
    if (!costs) {
      for (auto& [views, pose] : undecided) {
        scene->relative_poses.at(views) = std::move(pose);
      }
      return tl::unexpected<Error>(costs.error());
    }
    for (const auto& [views, of_pair] : *costs) {
      const HypothesisDecision decision =
          ChooseHypothesis(of_pair, margin, HypothesisGrounds::kCycles,
                           &scene->relative_poses.at(views));
      if (decision.grounds == HypothesisGrounds::kNone) continue;
      decisions.push_back(decision);
      changed = true;
    }
  }
  return decisions;
}

}  // namespace lowlap
