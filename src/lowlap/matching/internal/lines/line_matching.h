#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/features/internal/lines/line_descriptor.h"
#include "lowlap/matching/match_options.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Raised whenever the matches change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kLineMatchingVersion = 2;

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
