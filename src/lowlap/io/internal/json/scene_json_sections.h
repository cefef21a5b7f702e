#pragma once

#include <string>

#include "lowlap/io/internal/json/json_value.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The seven top-level keys of OpenMVG, in `root`, and the value of the key
/// "lowlap". They throw Failure.
Scene ReadOpenMvgSections(const JsonValue& root);
void ReadOwnSections(const JsonValue& own, Scene& scene);

/// The same as text, each section as `"name": value`, separated by ",\n".
void AppendOpenMvgSections(const Scene& scene, std::string& text);
void AppendOwnSections(const Scene& scene, std::string& text);

/// OpenMVG's name of the member that holds a model's distortion coefficients;
/// empty for a model without.
std::string DistortionKey(CameraModel model);

}  // namespace lowlap
