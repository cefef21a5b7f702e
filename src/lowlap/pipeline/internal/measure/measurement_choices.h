#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/scale/scale_options.h"

namespace lowlap {

/// What users choose of the measurements, in words.
struct MeasurementChoices {
  std::string matcher = "exact";                            // or flann
  std::vector<std::string> two_view = {"points", "lines"};  // some of these
  double max_tilt = TiltOptions().max_tilt;
};

/// Sets the options that follow. Lines are detected and matched if relative
/// poses are estimated from them, or the scale ratios ask for a kind of lines.
/// kInvalidArgument, with what is known, for another word.
Status SetChoices(const MeasurementChoices& choices, const ScaleOptions& scale,
                  MeasurementOptions* options);

}  // namespace lowlap
