#pragma once

#include <string>
#include <utility>

#include "lowlap/io/internal/json/json_value.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The seven top-level keys of OpenMVG, in `root`, and the value of the key
/// "lowlap". They throw Failure.
Scene ReadOpenMvgSections(const JsonValue& root);
void ReadOwnSections(const JsonValue& own, Scene& scene);

/// Adds an entry to a map of the scene; `key` is where its id, the number of
/// `what`, stands.
template <class Map, class Value>
void Insert(Map& map, const JsonValue& key, Value value,
            const std::string& what = "id") {
  if (!map.emplace(key.Id(), std::move(value)).second) {
    key.Fail(what + " " + std::to_string(key.Id()) + " is repeated",
             ErrorCode::kInvalidScene);
  }
}

/// The sections as text, each section as `"name": value`, separated by ",\n".
void AppendOpenMvgSections(const Scene& scene, std::string& text);
void AppendOwnSections(const Scene& scene, std::string& text);

/// OpenMVG's name of the member that holds a model's distortion coefficients;
/// empty for a model without.
std::string DistortionKey(CameraModel model);

}  // namespace lowlap
