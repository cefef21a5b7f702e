#include "lowlap/study/internal/subset_runs.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <mutex>
#include <set>
#include <utility>

#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"
#include "lowlap/study/internal/trust/position_errors.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxSubsets = 1000000;

// n choose k, or kMaxSubsets + 1 if it is larger than that.
std::size_t CountSubsets(std::size_t n, std::size_t k) {
  double count = 1;
  for (std::size_t i = 1; i <= k; ++i) {
    count = count * static_cast<double>(n - k + i) / static_cast<double>(i);
    if (count > static_cast<double>(kMaxSubsets)) return kMaxSubsets + 1;
  }
  return static_cast<std::size_t>(std::llround(count));
}

std::vector<std::vector<ViewId>> AllSubsets(const std::vector<ViewId>& views,
                                            std::size_t size) {
  std::vector<std::vector<ViewId>> subsets;
  std::vector<std::size_t> chosen(size);
  for (std::size_t i = 0; i < size; ++i) chosen[i] = i;
  while (true) {
    std::vector<ViewId> subset;
    subset.reserve(size);
    for (const std::size_t i : chosen) subset.push_back(views[i]);
    subsets.push_back(std::move(subset));
    std::size_t at = size;
    while (at > 0 && chosen[at - 1] == views.size() - size + at - 1) --at;
    if (at == 0) return subsets;
    ++chosen[at - 1];
    for (std::size_t i = at; i < size; ++i) chosen[i] = chosen[i - 1] + 1;
  }
}

std::vector<std::vector<ViewId>> SampleSubsets(const std::vector<ViewId>& views,
                                               std::size_t size,
                                               std::size_t count,
                                               std::uint64_t seed) {
  Random random(seed);
  std::set<std::vector<ViewId>> drawn;
  while (drawn.size() < count) {
    std::set<ViewId> subset;
    while (subset.size() < size) {
      subset.insert(
          views[random.Index(static_cast<std::uint32_t>(views.size()))]);
    }
    drawn.emplace(subset.begin(), subset.end());
  }
  return {drawn.begin(), drawn.end()};
}

void JudgeSubset(const Scene& scene, const GroundTruth& truth,
                 const SolveResult& result, SubsetOutcome* outcome) {
  outcome->num_placed = result.poses.num_placed;
  outcome->doubts = DoubtCodes(result.poses);
  const PoseEvaluation evaluation = EvaluatePoses(scene, truth);
  outcome->mean_error = evaluation.position.mean;
  outcome->max_error = evaluation.position.max;
  for (const ViewPoseError& error : evaluation.views) {
    if (evaluation.scope == EvaluationScope::kFull &&
        error.position_error == evaluation.position.max) {
      outcome->worst_view = error.view;
    }
  }
  const PositionErrors errors = RobustPositionErrors(scene, truth, kGoodCamera);
  const std::map<ViewId, GradedView> grades = GradeViews(result.poses);
  for (const auto& [view, share] : errors.error) {
    const auto graded = grades.find(view);
    if (graded == grades.end() || !std::isfinite(share)) continue;
    const bool is_firm = graded->second.grade == ViewGrade::kFirm;
    (is_firm ? outcome->firm_errors : outcome->doubtful_errors)[view] =
        share * errors.size;
  }
  Scene before;
  before.views = scene.views;
  before.poses = result.poses_before_adjustment;
  outcome->mean_error_before_adjustment =
      EvaluatePoses(before, truth).position.mean;
}

SubsetOutcome SolveSubset(const Scene& scene, const GroundTruth& truth,
                          const std::vector<ViewId>& dropped,
                          SolveOptions options, const RunContext& context) {
  const auto start = std::chrono::steady_clock::now();
  SubsetOutcome outcome;
  outcome.dropped = dropped;
  Scene subset = WithoutViews(scene, dropped);
  outcome.num_views = static_cast<int>(subset.views.size());
  auto& refined = options.adjustment.refine_intrinsics;
  for (auto it = refined.begin(); it != refined.end();) {
    it = subset.intrinsics.count(it->first) > 0 ? std::next(it)
                                                : refined.erase(it);
  }
  StageLog stages;
  const auto result = SolveScene(&subset, options, context, &stages);
  if (result) {
    JudgeSubset(subset, truth, *result, &outcome);
  } else {
    outcome.failure = result.error().ToString();
  }
  outcome.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  return outcome;
}

}  // namespace

std::vector<std::string> DoubtCodes(const PoseSummary& summary) {
  std::vector<std::string> codes;
  const auto add = [&](const std::string& code) {
    if (std::find(codes.begin(), codes.end(), code) == codes.end()) {
      codes.push_back(code);
    }
  };
  if (!summary.loops.empty()) add("open_loop");
  if (!summary.weak_ratios.empty()) add("weak_ratio");
  for (const ViewDoubt& doubt : ViewDoubts(summary)) add(doubt.reason);
  return codes;
}

Result<std::vector<std::vector<ViewId>>> ChooseSubsets(const Scene& scene,
                                                       int num_dropped,
                                                       std::size_t sample,
                                                       std::uint64_t seed) {
  std::vector<ViewId> views;
  for (const auto& entry : scene.views) views.push_back(entry.first);
  const std::size_t size = static_cast<std::size_t>(std::max(num_dropped, 0));
  if (num_dropped < 1 || size + 3 > views.size()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "of " + std::to_string(views.size()) +
                         " views, at least one must be dropped and three must "
                         "remain; asked for are " +
                         std::to_string(num_dropped));
  }
  const std::size_t count = CountSubsets(views.size(), size);
  if (sample > 0 && sample < count) {
    if (sample > kMaxSubsets) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "a sample holds at most a million subsets");
    }
    return SampleSubsets(views, size, sample, seed);
  }
  if (count > kMaxSubsets) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "there are more than a million ways to drop " +
                         std::to_string(num_dropped) + " of " +
                         std::to_string(views.size()) +
                         " views: ask for a sample of them");
  }
  return AllSubsets(views, size);
}

Status RunSubsets(const Scene& scene, const GroundTruth& truth,
                  const std::vector<std::vector<ViewId>>& dropped,
                  const SolveOptions& options, const RunContext& context,
                  const std::function<Status(const SubsetOutcome&)>& done) {
  if (const Status valid = options.Validate(); !valid) return valid;
  if (dropped.empty()) return {};
  auto ratios = EstimateScaleRatios(scene, FindTriplets(ViewGraph(scene)),
                                    *options.scale_estimator, context);
  if (!ratios) return tl::unexpected<Error>(ratios.error());
  Scene measured = scene;
  measured.scale_ratios = std::move(*ratios);
  SolveOptions each = options;
  each.reuse_ratios = true;

  Status failed;
  std::mutex mutex;
  RunContext single;
  single.num_threads = 1;
  single.seed = context.seed;
  single.progress = [&](const std::string&, std::size_t, std::size_t) {
    const std::lock_guard<std::mutex> lock(mutex);
    return failed.has_value();
  };
  RunContext all = context;
  all.progress = [&](const std::string& stage, std::size_t n,
                     std::size_t total) {
    const std::lock_guard<std::mutex> lock(mutex);
    return failed.has_value() && context.Progress(stage, n, total);
  };
  const Status status =
      ParallelFor(all, "subsets", dropped.size(), [&](std::size_t n) {
        const SubsetOutcome outcome =
            SolveSubset(measured, truth, dropped[n], each, single);
        const std::lock_guard<std::mutex> lock(mutex);
        if (failed) failed = done(outcome);
      });
  return failed ? status : failed;
}

}  // namespace lowlap
