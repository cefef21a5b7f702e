#pragma once

#include <string>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// The JavaScript object {points, segments, cameras} of flat coordinate lists,
/// in a frame whose z axis is the mean up direction of the cameras, centred on
/// the median of what is drawn and scaled so that nine tenths of it lie within
/// the unit ball. A camera is its centre and the four corners of its frustum.
std::string DrawingData(const Scene& scene, std::size_t max_points);

}  // namespace lowlap
