#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "third_party_adapters/bundler/internal/centered_model.h"

namespace lowlap::bundler {

// The problems of "Bundle Adjustment in the Large" (Agarwal et al., ECCV 2010):
//
//   number of cameras, points and observations
//   per observation: camera, point, x, y
//   per camera: angle-axis vector of R (3), t (3), f, k1, k2
//   per point: X (3)
//
// with the frames of bundle.h. There are neither names nor features.

/// Whether a file starts so: three counts, then a line of two indices and two
/// coordinates.
bool IsBalStart(std::string_view start);

/// Errors: kParse with file and line for text that is malformed, ends early or
/// goes on, and for indices of what is not there.
Result<CenteredModel> ParseBal(std::string_view text, const std::string& file);

/// Every camera of the model must have a pose.
std::string FormatBal(const CenteredModel& model);

}  // namespace lowlap::bundler
