#include "lowlap/averaging/reliability/internal/hanging_views.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/averaging/reliability/internal/solution_agreement.h"
#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/averaging/rigidity/internal/rigidity.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

void WarnOfHangingViews(PoseSummary* summary) {
  std::vector<ReliabilityWarning>& warnings = summary->reliability_warnings;
  warnings.erase(std::remove_if(warnings.begin(), warnings.end(),
                                [](const ReliabilityWarning& warning) {
                                  return warning.reason ==
                                         WarningReason::kDoubtfulNeighbors;
                                }),
                 warnings.end());
  std::set<ViewId> doubtful;
  for (const ViewDoubt& doubt : ViewDoubts(*summary)) {
    doubtful.insert(doubt.views.begin(), doubt.views.end());
  }
  if (doubtful.empty() || summary->components.empty()) return;
  const ViewGraph graph = ViewGraph(summary->firm_evidence.edges)
                              .WithoutViews({doubtful.begin(), doubtful.end()});
  const SolutionAgreement agreement =
      summary->agreement ? *summary->agreement : SolutionAgreement();
  const RigidityReport report = AnalyzeRigidity(
      graph, summary->firm_evidence.ratios, agreement.flat, agreement.narrow);
  const std::vector<ViewId>& placed = summary->components.front();
  std::set<ViewId> firm;
  if (!report.groups.empty()) {
    const std::vector<ViewId>& largest = report.groups.front().views;
    // Nothing says which of two parts is in its place.
    const bool is_tie = report.groups.size() > 1 &&
                        report.groups[1].views.size() == largest.size();
    const bool is_minority = 2 * largest.size() < placed.size();
    // Two views hold each other whatever is wrong.
    if ((largest.size() > 2 && !is_tie && !is_minority) || placed.size() <= 2) {
      firm.insert(largest.begin(), largest.end());
    }
  }
  ReliabilityWarning hanging;
  hanging.reason = WarningReason::kDoubtfulNeighbors;
  for (const ViewId view : placed) {
    if (doubtful.count(view) + firm.count(view) == 0) {
      hanging.views.push_back(view);
    }
  }
  if (!hanging.views.empty()) warnings.push_back(std::move(hanging));
}

}  // namespace lowlap
