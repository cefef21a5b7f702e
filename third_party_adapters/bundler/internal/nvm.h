#pragma once

#include <string>
#include <string_view>

#include "lowlap/core/result.h"
#include "lowlap/io/scene_format.h"
#include "third_party_adapters/bundler/internal/centered_model.h"

namespace lowlap::bundler {

// The N-View Match files of VisualSFM, NVM_V3:
//
//   NVM_V3 [FixedK fx cx fy cy r]
//   number of cameras
//   per camera: name, f, quaternion w x y z, centre, d, 0
//   number of points
//   per point: X, colour, number of observations,
//              each as camera, feature, x, y
//   0
//
// in our axes; in NVM_V3_R9T nine numbers of the rotation and t = -R C stand in
// place of quaternion and centre. d is k of RadialForm::kUndistorts.
// Measurements are relative to the principal point, y down, as VisualSFM writes
// them. Other programs write pixels from the corner of the image, told by no
// measurement being negative; such files are read where FixedK says the
// principal point.

/// The first model of a file. Errors: kParse with file and line for text that
/// is malformed, ends early or names a camera that is not there; kUnsupported
/// for measurements from the corner without FixedK.
Result<CenteredModel> ParseNvm(std::string_view text, const std::string& file,
                               SceneNotes* notes);

/// Every camera of the model must have a pose. Images without a name are called
/// image0, image1, ... by their place. kUnsupported for a name with a blank.
Result<std::string> FormatNvm(const CenteredModel& model);

}  // namespace lowlap::bundler
