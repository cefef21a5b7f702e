#pragma once

#include <cstddef>
#include <vector>

namespace lowlap {

/// Evidence that two elements belong together (positive) or do not (negative).
struct SignedLink {
  std::size_t first = 0;
  std::size_t second = 0;
  double evidence = 0;
};

/// Clusters of the elements 0..count-1 such that little evidence is overruled:
/// of all clusters those two are joined that have most evidence between them,
/// added up with its signs, until none is left that is positive (greedy
/// additive edge contraction: Keuper et al., "Efficient decomposition of image
/// and mesh graphs by lifted multicuts", ICCV 2015). A few false links do not
/// join what many keep apart. Returns a label per element, 0, 1, ... in the
/// order of first appearance. Links of one pair of elements add up.
std::vector<std::size_t> ClusterByLinks(std::size_t count,
                                        const std::vector<SignedLink>& links);

}  // namespace lowlap
