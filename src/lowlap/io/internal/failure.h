#pragma once

#include <string>
#include <utility>

#include "lowlap/core/result.h"
#include "lowlap/scene/validation.h"

namespace lowlap {

/// Thrown while a file is taken apart, and caught at the boundary of io.
struct Failure {
  Error error;
};

/// What `take_apart()` returns; a Failure that it throws is its error.
template <class TakeApart>
auto Caught(const TakeApart& take_apart) -> Result<decltype(take_apart())> {
  try {
    return take_apart();
  } catch (Failure& failure) {
    return tl::unexpected<Error>(std::move(failure.error));
  }
}

/// The scene that `take_apart()` returns, if it is valid. Errors name the file.
template <class TakeApart>
Result<Scene> CaughtScene(const TakeApart& take_apart,
                          const std::string& file) {
  Result<Scene> scene = Caught(take_apart);
  if (scene) {
    if (Status valid = ValidateScene(*scene); !valid) {
      scene = tl::unexpected<Error>(std::move(valid).error());
    }
  }
  if (!scene) scene.error().file = file;
  return scene;
}

}  // namespace lowlap
