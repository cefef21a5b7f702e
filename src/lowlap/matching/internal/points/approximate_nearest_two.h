#pragma once

#include <vector>

#include "lowlap/matching/internal/points/nearest_two.h"

namespace lowlap {

/// FindNearestTwo in a tree of k-means (FLANN; Muja & Lowe, PAMI 2014), in time
/// that hardly grows with the database: some answers are not the nearest. The
/// same for the same input; distances are exact.
std::vector<NearestTwo> FindNearestTwoApproximately(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database);

}  // namespace lowlap
