#include "lowlap/pipeline/internal/decisions/settle_contests.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/reliability/internal/agreeing_poses.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/decisions/compose_again.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

// What third views say of one solution's relative poses.
class ThirdViews {
 public:
  ThirdViews(const Scene& scene, const PoseSummary& poses) : scene_(scene) {
    for (const ScaleRatio& ratio : scene.scale_ratios) {
      known_.emplace(ratio.views, &ratio);
    }
    in_use_ = AgreeingPoses(scene, poses);
  }

  // Those whose ratio bears the pair out if it is meaningful: with a relative
  // pose in use that is none of the contested `links`.
  std::vector<ViewTriplet> Witnesses(const ViewPair& pair,
                                     const std::vector<ViewPair>& links) const {
    std::vector<ViewTriplet> witnesses;
    for (const auto& [middle, other] : {std::pair(pair.first, pair.second),
                                        std::pair(pair.second, pair.first)}) {
      for (const ViewId third : in_use_.NeighborsOf(middle)) {
        const ViewPair partner = OrderedPair(middle, third);
        if (third == other ||
            std::find(links.begin(), links.end(), partner) != links.end()) {
          continue;
        }
        witnesses.push_back(
            {std::min(other, third), middle, std::max(other, third)});
      }
    }
    return witnesses;
  }

  // The links of a cut, and which of the others join the same two sides.
  std::vector<ViewPair> Across(const std::vector<ViewPair>& links,
                               const std::set<ViewPair>& others) const {
    std::map<ViewId, std::size_t> part_of;
    std::size_t num_parts = 0;
    for (const std::vector<ViewId>& views :
         ConnectedComponents(in_use_.WithoutPairs(links))) {
      for (const ViewId view : views) part_of[view] = num_parts;
      ++num_parts;
    }
    const auto parts_of = [&](const ViewPair& pair) {
      return std::minmax({part_of.at(pair.first), part_of.at(pair.second)});
    };
    std::set<std::pair<std::size_t, std::size_t>> joined;
    for (const ViewPair& link : links) joined.insert(parts_of(link));
    std::vector<ViewPair> across = links;
    for (const ViewPair& pair : others) {
      if (part_of.count(pair.first) > 0 && part_of.count(pair.second) > 0 &&
          joined.count(parts_of(pair)) > 0) {
        across.push_back(pair);
      }
    }
    return across;
  }

  Status Estimate(const std::set<ViewTriplet>& triplets,
                  const ScaleEstimator& estimator, const RunContext& context) {
    std::vector<ViewTriplet> missing;
    for (const ViewTriplet& views : triplets) {
      if (known_.count(views) == 0) missing.push_back(views);
    }
    LOWLAP_ASSIGN_OR_RETURN(
        estimated_, EstimateScaleRatios(scene_, missing, estimator, context));
    for (const ScaleRatio& ratio : estimated_) {
      known_.emplace(ratio.views, &ratio);
    }
    return {};
  }

  // The evidence of the pair, as far as the best witness bears it out.
  double EvidenceOf(const ViewPair& pair,
                    const std::vector<ViewTriplet>& witnesses) const {
    double best = EvidenceOfNfa(0);
    for (const ViewTriplet& views : witnesses) {
      const auto ratio = known_.find(views);
      if (ratio == known_.end() ||
          ratio->second->verdict != RatioVerdict::kMeaningful ||
          IsWeak(*ratio->second, {})) {
        continue;
      }
      best = std::max(best, EvidenceOfNfa(ratio->second->log10_nfa));
    }
    return std::min(best,
                    EvidenceOfNfa(scene_.relative_poses.at(pair).log10_nfa));
  }

 private:
  const Scene& scene_;
  ViewGraph in_use_;
  std::vector<ScaleRatio> estimated_;
  std::map<ViewTriplet, const ScaleRatio*> known_;
};

// The contests with a contradiction about which third views were not asked.
std::vector<Contest> NewContests(const PoseSummary& poses,
                                 const std::set<ViewPair>& asked) {
  std::vector<Contest> contests;
  for (const Contest& contest : poses.contests) {
    if (std::any_of(
            contest.contradictions.begin(), contest.contradictions.end(),
            [&](const ViewPair& pair) { return asked.count(pair) == 0; })) {
      contests.push_back(contest);
    }
  }
  return contests;
}

std::set<ViewPair> OutByDirection(const PoseSummary& poses) {
  std::set<ViewPair> pairs;
  for (const auto* edges : {&poses.outlier_edges, &poses.kept_outliers}) {
    for (const OutlierEdge& edge : *edges) {
      if (edge.reason == OutlierReason::kDirection) pairs.insert(edge.views);
    }
  }
  return pairs;
}

// What third views say of contests.
struct Answer {
  /// What of the evidence of contradictions and links counts.
  std::map<ViewPair, double> evidence;
  std::vector<ViewPair> outweighed;
};

void Raise(const ViewPair& pair, double value,
           std::map<ViewPair, double>* evidence) {
  double& counting = (*evidence)[pair];
  counting = std::max(counting, value);
}

Result<Answer> Ask(const Scene& scene, const PoseSummary& poses,
                   const std::vector<Contest>& contests,
                   const ScaleEstimator& estimator, const RunContext& context) {
  ThirdViews third_views(scene, poses);
  std::set<ViewTriplet> triplets;
  const auto add_witnesses = [&](const std::vector<ViewPair>& pairs,
                                 const std::vector<ViewPair>& links) {
    for (const ViewPair& pair : pairs) {
      for (const ViewTriplet& views : third_views.Witnesses(pair, links)) {
        triplets.insert(views);
      }
    }
  };
  for (const Contest& contest : contests) {
    add_witnesses(contest.contradictions, contest.links);
    add_witnesses(contest.weakest_links, contest.weakest_links);
  }
  LOWLAP_RETURN_IF_ERROR(third_views.Estimate(triplets, estimator, context));
  const std::set<ViewPair> by_direction = OutByDirection(poses);
  Answer answer;
  for (const Contest& contest : contests) {
    const auto is_weak = [&](const ViewPair& pair) {
      return scene.relative_poses.at(pair).weakness.has_value();
    };
    double against = 0, for_it = 0;
    bool of_directions = false;
    for (const ViewPair& pair : contest.contradictions) {
      const double evidence = third_views.EvidenceOf(
          pair, third_views.Witnesses(pair, contest.links));
      Raise(pair, evidence, &answer.evidence);
      if (!is_weak(pair)) against += evidence;
      of_directions = of_directions || by_direction.count(pair) > 0;
    }
    // What was left out for its direction goes with the links that turn the
    // views the same way.
    const std::vector<ViewPair> links =
        third_views.Across(contest.weakest_links,
                           of_directions ? std::set<ViewPair>() : by_direction);
    for (const ViewPair& pair : links) {
      const double evidence =
          third_views.EvidenceOf(pair, third_views.Witnesses(pair, links));
      Raise(pair, evidence, &answer.evidence);
      for_it += is_weak(pair) ? EvidenceOfNfa(0) : evidence;
    }
    if (links.empty() || against <= 2 * for_it) continue;
    answer.outweighed.insert(answer.outweighed.end(), links.begin(),
                             links.end());
  }
  return answer;
}

// The verdicts and what third views say of more contests.
ThirdViewVerdicts WithEvidence(ThirdViewVerdicts verdicts,
                               const Answer& answer) {
  for (const auto& [pair, evidence] : answer.evidence) {
    if (verdicts.outweighed.count(pair) == 0) {
      Raise(pair, evidence, &verdicts.evidence);
    }
  }
  return verdicts;
}

ThirdViewVerdicts WithOutweighed(ThirdViewVerdicts verdicts,
                                 const std::vector<ViewPair>& links) {
  for (const ViewPair& pair : links) {
    verdicts.outweighed.insert(pair);
    verdicts.evidence[pair] = EvidenceOfNfa(0);
  }
  return verdicts;
}

}  // namespace

Status SettleContests(const SolveOptions& options, const RunContext& context,
                      StageLog* stages, Scene* scene,
                      ComposedSolution* composed) {
  SceneRotations& rotations = composed->start.rotations;
  std::set<ViewPair> asked;
  for (;;) {
    const std::vector<Contest> contests = NewContests(composed->poses, asked);
    if (contests.empty()) return {};
    for (const Contest& contest : contests) {
      asked.insert(contest.contradictions.begin(),
                   contest.contradictions.end());
    }
    LOWLAP_ASSIGN_OR_RETURN(const Answer answer,
                            Ask(*scene, composed->poses, contests,
                                *options.scale_estimator, context));
    const ThirdViewVerdicts verdicts =
        WithEvidence(rotations.third_views, answer);
    const std::vector<ScaleRatio> known = scene->scale_ratios;
    auto again = ComposeAgain(rotations.matches,
                              WithOutweighed(verdicts, answer.outweighed),
                              options, context, stages, scene);
    if (!again && again.error().code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(again.error());
    }
    if (!again || again->poses.num_placed < composed->poses.num_placed) {
      scene->scale_ratios = known;
      LOWLAP_ASSIGN_OR_RETURN(
          again, ComposeAgain(rotations.matches, verdicts, options, context,
                              stages, scene));
    }
    rotations = std::move(again->start.rotations);
    asked.insert(rotations.third_views.outweighed.begin(),
                 rotations.third_views.outweighed.end());
    composed->ratios = again->ratios;
    composed->poses = std::move(again->poses);
  }
}

}  // namespace lowlap
