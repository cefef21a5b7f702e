#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// SyntheticOptions::pairs, parsed.
struct PairRule {
  bool cycle = false;
  bool loop = false;  // the window goes on from the last view to the first
  bool all = false;
  int window = 1;  // views at most so far apart, unless `all`

  static Result<PairRule> Parse(const std::string& text);
};

/// The pairs of views that have a relative pose, and their adjacency.
class PairGraph {
 public:
  /// `seen_together`: number of features that a pair sees; used for `all`.
  PairGraph(const PairRule& rule, int num_views,
            const std::map<ViewPair, int>& seen_together);

  const std::vector<ViewPair>& Pairs() const { return pairs_; }

  /// The pairs among `views` (sorted), in order.
  std::vector<ViewPair> PairsAmong(const std::vector<ViewId>& views) const;

  /// The connected components of `views` (sorted) that have two or more views,
  /// each sorted.
  std::vector<std::vector<ViewId>> Components(
      const std::vector<ViewId>& views) const;

 private:
  bool AreConnected(ViewId a, ViewId b) const;

  std::vector<ViewPair> pairs_;                 // sorted
  std::vector<std::vector<ViewId>> neighbors_;  // by view, sorted
};

}  // namespace lowlap
