#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {

/// Merges parts of a view graph whose relative scale the directions of their
/// edges fix. A part is a connected set of edges of known relative lengths, so
/// that its views are X_v = s x_v + t with a scale s and a translation t of its
/// own; `parts` holds one element per edge. Two parts become one iff s is the
/// same for both in every solution, for generic centres x in a plane:
/// photographs are mostly taken at one height, and what is rigid in the plane
/// is rigid in space.
///
/// Parts that share two views are one. Beyond that, scales depend on one
/// another only within blocks of parts that no single view separates; the null
/// space of X_v - t_b - s_b x_v = 0 over the views v shared by parts b is
/// computed for each block (dense, cubic). Blocks of more than 250 parts are
/// left as they are.
void MergeRigidParts(const std::vector<ViewPair>& edges, UnionFind* parts);

}  // namespace lowlap
