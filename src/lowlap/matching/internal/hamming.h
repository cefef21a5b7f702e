#pragma once

#include <vector>

#include "lowlap/features/line_descriptor.h"

namespace lowlap::internal {

/// Numbers of bits in which `query` differs from each of `others`, which
/// replace the content of `distances`.
void HammingDistances(const LineDescriptor& query,
                      const std::vector<LineDescriptor>& others,
                      std::vector<int>* distances);

}  // namespace lowlap::internal
