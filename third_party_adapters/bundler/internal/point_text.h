#pragma once

#include <string>

#include "lowlap/core/internal/token_reader.h"
#include "third_party_adapters/bundler/internal/centered_model.h"

namespace lowlap::bundler {

// What bundle.out and NVM files say of a point:
//   X, colour, number of observations, each as camera, feature, x, y;
// a feature of -1 is none. `y_sign` is -1 where y points up.

/// The next point. The reader fails for a camera or feature that is none.
CenteredPoint NextPoint(std::size_t num_cameras, double y_sign,
                        TokenReader* reader);

/// The same on one line, in white.
std::string PointText(const CenteredPoint& point, double y_sign);

}  // namespace lowlap::bundler
