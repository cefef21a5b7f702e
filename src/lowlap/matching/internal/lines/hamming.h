#pragma once

#include <vector>

#include "lowlap/features/internal/lines/line_descriptor.h"

namespace lowlap {

/// Numbers of bits in which `query` differs from each of `others`, which
/// replace the content of `distances`.
void HammingDistances(const LineDescriptor& query,
                      const std::vector<LineDescriptor>& others,
                      std::vector<int>* distances);

}  // namespace lowlap
