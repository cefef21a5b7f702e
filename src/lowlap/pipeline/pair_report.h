#pragma once

#include <string>
#include <vector>

#include "lowlap/core/ids.h"

namespace lowlap {

/// What became of one pair.
struct PairReport {
  ViewPair views;
  bool accepted = false;
  std::string reason;  // why not, if not
  std::string geometry;
  int num_point_matches = 0;
  int num_line_matches = 0;
  int num_point_inliers = 0;
  int num_line_inliers = 0;
  double log10_nfa = 0;
};

/// For people, where not one pair was accepted: how many were tried, and why
/// the one with the most matches was not.
std::string ExplainNoPose(const std::vector<PairReport>& pairs);

}  // namespace lowlap
