#include "lowlap/adjustment/internal/rounds/optimum_starts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <utility>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

// What it costs to leave one out.
double OneObservation(const NoiseLevels& noise) {
  const auto cost = [](const NoiseScale& kind) {
    return std::pow(kind.threshold_px / kind.stddev_px, 2);
  };
  return std::min(cost(noise.points), cost(noise.lines));
}

// A start, and what became of it.
struct Branch {
  std::string name;
  AdjustmentOptions kinds;  // those it begins with
  Optimum optimum;
  AdjustmentSummary summary;
  std::vector<std::pair<LogLevel, std::string>> messages;
  Status status;
};

std::vector<Branch> MakeBranches(const AdjustmentOptions& options,
                                 const Optimum& start, const Optimum& settled) {
  AdjustmentOptions lines = options;
  lines.use_points = false;
  AdjustmentOptions points = options;
  points.use_lines = false;
  points.use_coplanar = false;
  return {{"points and lines", options, settled, {}, {}, {}},
          {"lines first", lines, start, {}, {}, {}},
          {"points first", points, start, {}, {}, {}}};
}

// Searches side by side: their messages wait.
Status SearchAll(const AdjustmentOptions& options, const RunContext& context,
                 const Scene& scene, std::vector<Branch>* branches) {
  std::mutex mutex;
  const RunContext shared = ContextOfItem(context, branches->size(), &mutex);
  return ParallelFor(context, {}, branches->size(), [&](std::size_t n) {
    Branch& branch = (*branches)[n];
    RunContext own = shared;
    own.log = [&](LogLevel level, const std::string& message) {
      branch.messages.emplace_back(level, message);
    };
    OptimumSearch search(options, own, scene, &branch.optimum, &branch.summary,
                         n == 0 ? std::string() : branch.name + ": ");
    branch.status =
        n == 0 ? search.Complete() : search.CompleteFrom(branch.kinds);
  });
}

// A start that fails is none, but for the usual one.
Status Gather(const RunContext& context, std::vector<Branch>* branches,
              AdjustmentSummary* summary) {
  for (const Branch& branch : *branches) {
    for (const auto& [level, message] : branch.messages) {
      context.Log(level, message);
    }
    summary->solves.insert(summary->solves.end(), branch.summary.solves.begin(),
                           branch.summary.solves.end());
    summary->iterations += branch.summary.iterations;
    summary->outlier_rounds += branch.summary.outlier_rounds;
    if (!branch.status &&
        (&branch == &branches->front() ||
         branch.status.error().code == ErrorCode::kCancelled)) {
      return branch.status;
    }
  }
  const auto failed = [](const Branch& branch) { return !branch.status; };
  branches->erase(std::remove_if(branches->begin(), branches->end(), failed),
                  branches->end());
  return {};
}

Result<std::vector<Rival>> Choose(const RunContext& context,
                                  const std::vector<Branch>& branches,
                                  Optimum* optimum) {
  // One noise level for all, or their costs could not be compared.
  const Optimum& usual = branches.front().optimum;
  std::vector<double> costs;
  for (const Branch& branch : branches) {
    LOWLAP_ASSIGN_OR_RETURN(const double cost,
                            CostOf(branch.optimum, usual, context));
    costs.push_back(cost);
  }
  const auto best = std::min_element(costs.begin(), costs.end());
  std::vector<Rival> rivals;
  for (std::size_t n = 0; n < branches.size(); ++n) {
    const Branch& branch = branches[n];
    if (&costs[n] == &*best) {
      *optimum = branch.optimum;
    } else if (costs[n] <= *best + OneObservation(usual.noise)) {
      rivals.push_back({branch.name, branch.optimum.cameras});
    }
  }
  return rivals;
}

}  // namespace

Result<std::vector<Rival>> FindOptimum(const AdjustmentOptions& options,
                                       const RunContext& context,
                                       const Scene& scene, Optimum* optimum,
                                       AdjustmentSummary* summary) {
  OptimumSearch search(options, context, scene, optimum, summary);
  LOWLAP_RETURN_IF_ERROR(search.Prepare());
  const Optimum start = *optimum;
  LOWLAP_RETURN_IF_ERROR(search.Settle());
  std::vector<Rival> rivals;
  if (options.max_outlier_rounds > 0 && options.use_points &&
      options.use_lines && MostAreSeenTwice(optimum->state)) {
    std::vector<Branch> branches = MakeBranches(options, start, *optimum);
    LOWLAP_RETURN_IF_ERROR(SearchAll(options, context, scene, &branches));
    LOWLAP_RETURN_IF_ERROR(Gather(context, &branches, summary));
    LOWLAP_ASSIGN_OR_RETURN(rivals, Choose(context, branches, optimum));
  } else {
    LOWLAP_RETURN_IF_ERROR(search.Complete());
  }
  LOWLAP_RETURN_IF_ERROR(search.Finish());
  return rivals;
}

}  // namespace lowlap
