#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"
#include "lowlap/study/internal/subset_runs.h"

namespace lowlap {

/// Bounds that a summary of subsets counts by, in the truth's unit (metres for
/// the defaults).
struct SubsetBounds {
  double accurate = 0.05;  // a good solution
  double failed = 0.5;     // a camera beyond this is wrong

  Status Validate() const;
};

/// Counts over the outcomes of all subsets.
struct SubsetSummary {
  std::size_t num_subsets = 0;
  std::size_t num_complete = 0;       // all remaining views placed
  std::size_t num_accurate_mean = 0;  // of these, mean error within bounds
  std::size_t num_accurate = 0;       // and the largest error as well
  std::size_t num_flagged = 0;
  /// A camera beyond `failed` in a solution that was flagged, or was not.
  std::size_t num_flagged_failures = 0;
  std::size_t num_silent_failures = 0;
  /// Cameras of all outcomes (SubsetOutcome::firm_errors, doubtful_errors).
  std::size_t num_good_cameras = 0;   // not beyond `accurate`
  std::size_t num_good_doubted = 0;   // of these
  std::size_t num_wrong_cameras = 0;  // beyond `failed`
  std::size_t num_wrong_firm = 0;     // of these: no warning names them
  double median_mean_error = 0;       // of the complete ones, if there are any
  double median_max_error = 0;
  double seconds = 0;  // of all subsets
};

SubsetSummary SummarizeSubsets(const std::vector<SubsetOutcome>& outcomes,
                               const SubsetBounds& bounds);

/// A camera is wrong, and nothing warned of anything.
bool IsSilentFailure(const SubsetOutcome& outcome, const SubsetBounds& bounds);

/// The cameras that are wrong and that no warning names, by view.
std::vector<ViewId> WrongFirmViews(const SubsetOutcome& outcome,
                                   const SubsetBounds& bounds);

/// The table as CSV: a header, and one line for each subset. `dropped` holds
/// view ids joined by '+'. Errors are empty where fewer than three cameras are
/// placed.
std::string ToCsv(const std::vector<SubsetOutcome>& outcomes,
                  const Scene& scene);

/// A record of a ResultLog, and the inverse; nullopt for anything else.
std::string ToJsonLine(const SubsetOutcome& outcome);
std::optional<SubsetOutcome> SubsetFromJsonLine(const std::string& line);

std::string ToText(const SubsetSummary& summary, const SubsetBounds& bounds);
std::string ToJson(const SubsetSummary& summary, const SubsetBounds& bounds);

/// The share of all subsets whose mean (largest) error is at most x, as an SVG
/// document. Subsets that are not complete never count.
Result<std::string> DrawSubsets(const std::vector<SubsetOutcome>& outcomes);

}  // namespace lowlap
