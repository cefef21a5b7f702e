#include "lowlap/averaging/centers/internal/side_search.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "lowlap/averaging/centers/internal/grown_centers.h"
#include "lowlap/averaging/centers/internal/length_balance.h"
#include "lowlap/averaging/centers/internal/scene_contests.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/internal/problem_errors.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

// Views of all contests that are tried: large scenes, which solve slowly, try
// few.
constexpr std::size_t kMaxViewsTried = 3000;

class SideSearch {
 public:
  SideSearch(const Scene& scene, const SceneRotations& rotations,
             const PoseOptions& options, const RunContext& context,
             SideStart start)
      : scene_(scene),
        rotations_(rotations),
        options_(options),
        context_(context),
        start_(start) {
    std::vector<ViewPair> others;
    std::set<ViewPair> little_turned;
    for (const OutlierEdge& edge : rotations.outliers) {
      left_out_before_.push_back(edge.views);
      if (IsTurnedALittle(edge)) little_turned.insert(edge.views);
    }
    std::sort(left_out_before_.begin(), left_out_before_.end());
    for (const auto& entry : scene.relative_poses) {
      if (little_turned.count(entry.first) == 0) others.push_back(entry.first);
    }
    little_turned_ =
        MakeTranslationProblem(scene, rotations.cam_from_world, others);
  }

  Result<SideFound> Run() && {
    LOWLAP_ASSIGN_OR_RETURN(now_, Solve({}));
    LOWLAP_RETURN_IF_ERROR(start_ == SideStart::kGrown ? BeginGrown()
                                                       : TryStrongestAlone());
    bool is_better = true;
    while (is_better) {
      LOWLAP_ASSIGN_OR_RETURN(is_better, TryOtherSides());
      if (is_better) continue;
      LOWLAP_ASSIGN_OR_RETURN(is_better, TryWithoutOne());
    }
    return SideFound{std::move(now_), std::move(contests_)};
  }

 private:
  Result<Side> Solve(const std::vector<ViewPair>& without) const {
    Side side;
    LOWLAP_ASSIGN_OR_RETURN(
        side.centers,
        SolveSceneCenters(scene_, rotations_, without, options_, context_));
    for (const auto* edges :
         {&side.centers.outlier_edges, &side.centers.kept_outliers}) {
      for (const OutlierEdge& edge : *edges) {
        side.against[edge.views] = EvidenceOf(edge.views);
      }
    }
    EraseBorneOut(&side);
    AddContradictedLengths(&side);
    return side;
  }

  // What was left out for a little turn speaks for centres that its direction
  // agrees with.
  void EraseBorneOut(Side* side) const {
    const SceneCenters& centers = side->centers;
    for (const DirectionEdge& edge : little_turned_.edges) {
      if (IsPlaced(centers.solution, edge) &&
          DirectionErrorRad(centers.solution, edge) <=
              LimitsOf(options_).DirectionRad(centers.sigma_rad,
                                              edge.stddev_rad)) {
        side->against.erase(ViewsOf(little_turned_, edge));
      }
    }
  }

  void AddContradictedLengths(Side* side) const {
    const SceneCenters& centers = side->centers;
    for (const std::size_t edge :
         ContradictedLengths(centers.problem, centers.solution,
                             LimitsOf(options_), centers.sigma_rad)) {
      const ViewPair pair =
          ViewsOf(centers.problem, centers.problem.edges[edge]);
      side->against[pair] = EvidenceOf(pair);
    }
  }

  double EvidenceOf(const ViewPair& pair) const {
    return EvidenceOfNfa(scene_.relative_poses.at(pair).log10_nfa);
  }

  double EvidenceOf(const std::vector<ViewPair>& pairs) const {
    double sum = 0;
    for (const ViewPair& pair : pairs) sum += EvidenceOf(pair);
    return sum;
  }

  // Those first that most speaks against.
  std::vector<Contest> ContestsNow() const {
    std::vector<Contest> contests =
        FindSceneContests(scene_, rotations_, now_.centers);
    const auto excess = [&](const Contest& contest) {
      return EvidenceOf(contest.contradictions) - EvidenceOf(contest.links);
    };
    std::stable_sort(contests.begin(), contests.end(),
                     [&](const Contest& a, const Contest& b) {
                       return excess(a) > excess(b);
                     });
    return contests;
  }

  // Where something contradicts. What is built of the strongest relative poses
  // is not bent by the others; of these, those that agree are taken in again.
  Status TryStrongestAlone() {
    if (!now_.IsContradicted(rotations_)) return {};
    std::vector<ViewPair> weakest;
    for (const auto& entry : scene_.relative_poses) {
      if (!IsLeftOutBefore(entry.first)) weakest.push_back(entry.first);
    }
    std::stable_sort(weakest.begin(), weakest.end(),
                     [&](const ViewPair& a, const ViewPair& b) {
                       return EvidenceOf(a) < EvidenceOf(b);
                     });
    // The fewest that lose no view, by halving.
    std::size_t num_strongest = weakest.size() / 2, step = num_strongest / 2;
    for (int n = 0; n < 3; ++n, step /= 2) {
      const std::vector<ViewPair> without(
          weakest.begin(),
          weakest.end() - static_cast<std::ptrdiff_t>(num_strongest));
      LOWLAP_ASSIGN_OR_RETURN(std::optional<Side> side, SideWithout(without));
      num_strongest = side ? num_strongest - step : num_strongest + step;
      TakeIfBetter(&side);
    }
    return {};
  }

  // Where something contradicts: without what contradicts centres that grow.
  Status BeginGrown() {
    if (!now_.IsContradicted(rotations_)) return {};
    std::vector<ViewPair> turned;
    for (const OutlierEdge& edge : rotations_.outliers) {
      if (!IsTurnedALittle(edge)) turned.push_back(edge.views);
    }
    const TranslationProblem problem =
        MakeTranslationProblem(scene_, rotations_.cam_from_world, turned);
    EvidenceOfPairs evidence;
    for (const DirectionEdge& edge : problem.edges) {
      const ViewPair pair = ViewsOf(problem, edge);
      evidence[pair] = EvidenceOf(pair);
    }
    std::vector<ViewPair> without;
    for (const ViewPair& pair : ContradictionsOfGrowth(
             problem, evidence, LimitsOf(options_), MaxTried())) {
      if (!IsLeftOutBefore(pair)) without.push_back(pair);
    }
    LOWLAP_ASSIGN_OR_RETURN(std::optional<Side> side, SideWithout(without));
    if (side) now_ = *std::move(side);
    return {};
  }

  // So little that its direction still says where the views are.
  bool IsTurnedALittle(const OutlierEdge& edge) const {
    return RadFromDeg(edge.error_deg) <= LimitsOf(options_).DirectionRad(0, 0);
  }

  bool IsLeftOutBefore(const ViewPair& pair) const {
    return std::binary_search(left_out_before_.begin(), left_out_before_.end(),
                              pair);
  }

  // Nothing if that loses views or cannot be solved.
  Result<std::optional<Side>> SideWithout(
      const std::vector<ViewPair>& without) const {
    Result<Side> side = Solve(without);
    if (!side && side.error().code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(side.error());
    }
    if (!side || side->NumPlaced() < now_.NumPlaced()) return std::nullopt;
    return *std::move(side);
  }

  // What is left out now, but for some.
  std::vector<ViewPair> LeftOutBut(const std::vector<ViewPair>& some) const {
    std::vector<ViewPair> left_out;
    for (const OutlierEdge& edge : now_.centers.outlier_edges) {
      if (edge.reason == OutlierReason::kDirection &&
          !std::binary_search(some.begin(), some.end(), edge.views)) {
        left_out.push_back(edge.views);
      }
    }
    return left_out;
  }

  // With the contradictions and without some links.
  Result<std::optional<Side>> OtherSideOf(const Contest& contest,
                                          std::vector<ViewPair> without) const {
    const std::vector<ViewPair> others = LeftOutBut(contest.contradictions);
    without.insert(without.end(), others.begin(), others.end());
    return SideWithout(without);
  }

  // Whether one relative pose in use, the weakest first, bent the solution.
  Result<bool> TryWithoutOne() {
    if (!now_.IsContradicted(rotations_)) return false;
    std::vector<ViewPair> in_use;
    for (const DirectionEdge& edge : now_.centers.problem.edges) {
      in_use.push_back(ViewsOf(now_.centers.problem, edge));
    }
    std::stable_sort(in_use.begin(), in_use.end(),
                     [&](const ViewPair& a, const ViewPair& b) {
                       return EvidenceOf(a) < EvidenceOf(b);
                     });
    const std::vector<ViewPair> left_out = LeftOutBut({});
    for (const ViewPair& pair : in_use) {
      if (num_left_out_alone_++ >= MaxTried()) break;
      std::vector<ViewPair> without = left_out;
      without.push_back(pair);
      LOWLAP_ASSIGN_OR_RETURN(std::optional<Side> side, SideWithout(without));
      if (TakeIfBetter(&side)) return true;
    }
    return false;
  }

  // Whether one was better, and is the solution now.
  Result<bool> TryOtherSides() {
    contests_.clear();
    for (Contest& contest : ContestsNow()) {
      const auto [entry, is_new] = is_decided_.emplace(
          std::pair(contest.links, contest.contradictions), false);
      if (is_new && is_decided_.size() <= MaxTried()) {
        LOWLAP_ASSIGN_OR_RETURN(std::optional<Side> both,
                                OtherSideOf(contest, {}));
        if (TakeIfBetter(&both)) return true;
        LOWLAP_ASSIGN_OR_RETURN(std::optional<Side> other,
                                OtherSideOf(contest, contest.links));
        if (TakeIfBetter(&other)) return true;
        entry->second = other && Decides(*other) &&
                        !WereLeftOutBefore(contest.contradictions);
      }
      if (!entry->second) contests_.push_back(std::move(contest));
    }
    return false;
  }

  bool TakeIfBetter(std::optional<Side>* side) {
    if (!*side || (*side)->EvidenceAgainst() >= now_.EvidenceAgainst()) {
      return false;
    }
    now_ = std::move(**side);
    return true;
  }

  std::size_t MaxTried() const {
    return std::max<std::size_t>(1, kMaxViewsTried / now_.NumPlaced());
  }

  // Whether so much more speaks against the other one.
  bool Decides(const Side& other) const {
    return other.EvidenceAgainstOnly(now_) >
           2 * now_.EvidenceAgainstOnly(other);
  }

  bool WereLeftOutBefore(const std::vector<ViewPair>& pairs) const {
    return std::any_of(pairs.begin(), pairs.end(), [&](const ViewPair& pair) {
      return IsLeftOutBefore(pair);
    });
  }

  const Scene& scene_;
  const SceneRotations& rotations_;
  const PoseOptions& options_;
  const RunContext& context_;
  const SideStart start_;
  std::vector<ViewPair> left_out_before_;
  TranslationProblem little_turned_;
  Side now_;
  // Of the contests that were tried, by links and contradictions.
  std::map<std::pair<std::vector<ViewPair>, std::vector<ViewPair>>, bool>
      is_decided_;
  std::vector<Contest> contests_;
  std::size_t num_left_out_alone_ = 0;
};

}  // namespace

bool Side::IsContradicted(const SceneRotations& rotations) const {
  const std::vector<ViewPair> turned = PairsOf(rotations.outliers);
  return std::any_of(against.begin(), against.end(), [&](const auto& entry) {
    return std::find(turned.begin(), turned.end(), entry.first) == turned.end();
  });
}

double Side::EvidenceAgainst() const {
  double sum = 0;
  for (const auto& entry : against) sum += entry.second;
  return sum;
}

double Side::EvidenceAgainstOnly(const Side& other) const {
  double sum = 0;
  for (const auto& [views, evidence] : against) {
    if (other.against.count(views) == 0) sum += evidence;
  }
  return sum;
}

Result<SideFound> SearchSides(const Scene& scene,
                              const SceneRotations& rotations,
                              const PoseOptions& options, SideStart start,
                              const RunContext& context) {
  return SideSearch(scene, rotations, options, context, start).Run();
}

}  // namespace lowlap
