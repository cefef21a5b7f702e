#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/evaluation/internal/line_truth.h"

namespace lowlap {

/// Line matches of one pair, or of all of them, by verdict.
struct LineMatchCounts {
  int num_matches = 0;
  int num_right = 0;
  int num_wrong = 0;
  int num_unknown = 0;
  /// Of the unknown, those that the true epipolar geometry excludes: the
  /// segments share no part of a line in front of both cameras.
  int num_excluded = 0;
  int num_common_edges = 0;   // shown by both images
  int num_matched_edges = 0;  // of these, with a right match

  /// right / (right + wrong); 0 without such a match.
  double Precision() const;
  /// matched / common edges; 0 without a common edge.
  double Recall() const;
};

struct PairLineMatches {
  ViewPair views;
  bool has_relative_pose = false;
  LineMatchCounts counts;
};

struct LineMatchEvaluation {
  std::vector<PairLineMatches> pairs;
  LineMatchCounts total;
  int num_without_truth = 0;  // pairs with a view that no truth is known of
};

/// Judges the line inliers of the relative poses of `pairs` by the true edges.
///
/// A match is right if both of its segments lie on one edge
/// (EdgeAssignmentRule). It is wrong if both lie on edges, but on none in
/// common; and if one lies on edges that the other image shows as well while
/// the other segment is not near any of them (the rule with twice the
/// tolerances). Everything else is unknown: the list of edges does not hold
/// shadows, texture, reflections. Recall is the share of the edges shown by
/// both images that have a right match. A pair without a relative pose has no
/// matches, and its edges count.
///
/// Views are tied to the list by the number that their file name is. Errors:
/// kInsufficientData if no pair can be judged.
Result<LineMatchEvaluation> EvaluateLineMatches(
    const Scene& scene, const GroundTruth& truth,
    const std::vector<TrueEdge>& edges, const std::vector<ViewPair>& pairs,
    const EdgeAssignmentRule& rule);

/// A table for people: one line per pair, then the total.
std::string ToText(const LineMatchEvaluation& evaluation);
/// A JSON object with the members' names, precision and recall.
std::string ToJson(const LineMatchEvaluation& evaluation);

}  // namespace lowlap
