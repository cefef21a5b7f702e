#pragma once

#include <vector>

#include "lowlap/matching/internal/nearest_two.h"

namespace lowlap::internal {

/// FindNearestTwo by randomised trees (FLANN; Muja & Lowe, PAMI 2014), in time
/// that hardly grows with the database: a few of a hundred answers are not the
/// nearest. The same for the same input; distances are exact.
std::vector<NearestTwo> FindNearestTwoApproximately(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database);

}  // namespace lowlap::internal
