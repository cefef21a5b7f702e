#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/report/internal/table_text.h"
#include "lowlap/study/internal/look_alikes/places.h"

namespace lowlap {

/// What repeats, whether both photographs show one place, and the seed.
using LookAlikeKey = std::tuple<RepeatedKind, bool, std::uint64_t>;

/// What EstimatePair made of two photographs, with its default options.
struct LookAlikeTrial {
  bool is_accepted = false;
  double log10_nfa = 0;  // of the pose, where accepted
  /// Against the truth, where accepted and of one place.
  double rotation_error_deg = 0;
  double direction_error_deg = 0;
  std::string reason;  // why it was refused
};

/// Photographs of places that have a repeated pattern in common and nothing
/// else, which no relative pose may join; and, for comparison, pairs of
/// photographs of one such place.
struct LookAlikeStudy {
  int num_pairs = 350;  // of each kind, of different places and of one
  std::map<LookAlikeKey, LookAlikeTrial> trials;
};

/// Fills the trials that are missing, of the seeds context.seed, context.seed +
/// 1, ... of every kind, as RunTrials does. Errors: those of `done`,
/// kInvalidArgument for a number of pairs below 1, kCancelled.
Status RunLookAlikeStudy(
    const RunContext& context,
    const std::function<Status(const LookAlikeKey&, const LookAlikeTrial&)>&
        done,
    LookAlikeStudy* study);

/// A row for each kind: how many pairs of different places are accepted, how
/// many of one place, and how many of these are within 2 degrees.
TextTable LookAlikeTable(const LookAlikeStudy& study);

/// What a complete study leaves, as (file name, content): pairs.csv,
/// summary.txt.
std::vector<std::pair<std::string, std::string>> LookAlikeFiles(
    const LookAlikeStudy& study);

}  // namespace lowlap
