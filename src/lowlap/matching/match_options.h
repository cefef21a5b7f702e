#pragma once

#include "lowlap/core/result.h"

namespace lowlap {

/// How nearest descriptors are found.
enum class PointMatcher {
  kExact,  // exhaustively: the cost grows with the product of the sizes
  kFlann,  // in a tree (FLANN): faster beyond some 200,000 points
};

struct PointMatchOptions {
  /// A match must be closer than this times the second nearest (Lowe 2004,
  /// section 7.1), seen from either image.
  double max_ratio = 0.8;
  PointMatcher matcher = PointMatcher::kExact;

  Status Validate() const;
};

struct RelaxedPointOptions {
  /// Pairs with fewer matches are matched again; 0: none.
  int starved_below = 60;
  double max_ratio = 0.9;  // of the second pass
  PointMatcher matcher = PointMatcher::kExact;
  /// So many of a match's nearest neighbours must lie where its own similarity
  /// puts them, up to a share of their distance.
  int neighbors = 8;
  int min_agreeing = 2;
  double max_deviation = 0.6;

  Status Validate() const;
};

/// Points that surfaces show when they are looked at from aside.
struct TiltedPointOptions {
  /// Pairs with fewer matches are matched again; 0: none.
  int starved_below = 100;
  /// Views with so many pairs that have more are joined well enough.
  int enough_pairs = 3;
  /// Of one view so many pairs are matched again, those of most matches.
  int max_partners = 12;
  /// As in PointMatchOptions, over all looks of an image together.
  double max_ratio = 0.8;

  Status Validate() const;
};

struct LineMatchOptions {
  /// Greatest Hamming distance of two descriptors of 256 bits.
  int max_distance_bits = 90;
  /// Partners that a segment may have before the neighbours decide.
  int max_candidates = 4;
  /// Least agreement with the neighbours, relative to the best match; in [0,
  /// 1].
  double min_score = 0.2;
  /// The longer segment is at most this many times the shorter one.
  double max_length_ratio = 4.0;

  Status Validate() const;
};

struct MatchOptions {
  bool match_points = true;
  bool match_lines = true;
  PointMatchOptions points;
  RelaxedPointOptions relaxed_points;
  TiltedPointOptions tilted_points;
  LineMatchOptions lines;

  Status Validate() const;
};

struct RetrievalOptions {
  /// Points per view that are compared.
  int sample_points = 500;
  /// Up to so many views, every one is compared with every other one, exactly;
  /// of more, the points are looked up in one index of all, which takes less
  /// time from there on (benchmark PairRetrieval).
  int max_exhaustive = 700;
  /// Partners that every view proposes; the pairs are those that either of
  /// their views proposes.
  int max_partners = 12;
  /// Ratio test of the sample's matches.
  double max_ratio = 0.8;

  Status Validate() const;
};

struct LineTrackOptions {
  /// Two segments of one view belong to one track only if all their end points
  /// are this close to a common line, lens distortion removed.
  double max_collinear_distance_px = 2.0;

  Status Validate() const;
};

struct PatchAlignmentOptions {
  int max_iterations = 30;
  /// The step, in units of the patch's grid, that counts as convergence.
  double min_step = 0.005;
  /// Least normalised cross-correlation of the aligned patches.
  double min_correlation = 0.9;
  /// Standard deviation of a keypoint about the true place, in units of its
  /// scale.
  double keypoint_stddev = 0.3;
  /// Farthest that a point may move, in standard deviations.
  double max_deviation = 3;

  Status Validate() const;
};

}  // namespace lowlap
