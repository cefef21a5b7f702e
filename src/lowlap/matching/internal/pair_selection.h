#pragma once

#include <string>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The pairs of views to match, each with first < second, sorted, no
/// duplicates. `specification` is one of
///   all       every pair
///   chain     consecutive views, in the order of their ids
///   cycle     the same, and the last with the first
///   window:N  views at most N places apart
///   anything else: the path of a file of pairs (ParsePairs).
/// "auto" is refused: it takes features to find those pairs (RetrievePairs).
/// Errors: kInvalidArgument, kNotFound, kParse (with file and line).
Result<std::vector<ViewPair>> SelectViewPairs(const Scene& scene,
                                              const std::string& specification);

/// Pairs from text, one per line: two views as ViewNames finds them, separated
/// by blanks; a name with blanks stands in double quotes. Empty lines and those
/// that start with '#' are skipped; text without any pair is kParse. `file` is
/// for messages only.
Result<std::vector<ViewPair>> ParsePairs(const Scene& scene,
                                         const std::string& text,
                                         const std::string& file);

}  // namespace lowlap
