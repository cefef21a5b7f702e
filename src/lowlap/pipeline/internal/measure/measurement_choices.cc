#include "lowlap/pipeline/internal/measure/measurement_choices.h"

#include <algorithm>

#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

bool Has(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

Status RequireKnown(const std::string& name, const std::string& word,
                    const std::vector<std::string>& known) {
  if (Has(known, word)) return {};
  return MakeError(
      ErrorCode::kInvalidArgument,
      name + ": '" + word + "' is not one of " + Joined(known, ", "));
}

}  // namespace

Status SetChoices(const MeasurementChoices& choices, const ScaleOptions& scale,
                  MeasurementOptions* options) {
  LOWLAP_RETURN_IF_ERROR(
      RequireKnown("matcher", choices.matcher, {"exact", "flann"}));
  for (const std::string& word : choices.two_view) {
    LOWLAP_RETURN_IF_ERROR(RequireKnown("two_view", word, {"points", "lines"}));
  }
  const PointMatcher matcher =
      choices.matcher == "flann" ? PointMatcher::kFlann : PointMatcher::kExact;
  options->matching.points.matcher = matcher;
  options->matching.relaxed_points.matcher = matcher;
  options->features.tilts.max_tilt = choices.max_tilt;
  LOWLAP_RETURN_IF_ERROR(options->features.tilts.Validate());
  PairOptions& pair = options->relative_poses.pair;
  pair.use_points = Has(choices.two_view, "points");
  pair.use_lines = Has(choices.two_view, "lines");
  const bool needs_lines =
      pair.use_lines || scale.Asks("lines") || scale.Asks("coplanar");
  options->features.detect_lines = needs_lines;
  options->matching.match_lines = needs_lines;
  return {};
}

}  // namespace lowlap
