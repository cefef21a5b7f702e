#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/features/line_descriptor.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Raised whenever the matches change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kLineMatchingVersion = 2;

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

/// One image's segments as matching sees them.
struct DescribedLines {
  const std::vector<LineSegment>& segments;
  const std::vector<LineDescriptor>& descriptors;
};

/// Segment matches by appearance that agree with their neighbours on how the
/// image turns, on which side of each other the segments lie, and on their
/// distance; sorted by the first index, every segment at most once.
///
/// Each segment keeps its nearest partners by descriptor, mutually; relaxation
/// over the neighbours in the image then scores every candidate by how well
/// the best candidates around it agree, and the best scores are taken first.
/// A match that nothing around it confirms, or that a contradicting one comes
/// close to, is not made.
std::vector<FeatureMatch> MatchLines(const DescribedLines& first,
                                     const DescribedLines& second,
                                     const LineMatchOptions& options);

}  // namespace lowlap
