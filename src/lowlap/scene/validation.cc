#include "lowlap/scene/validation.h"

namespace lowlap {

Status ValidateScene(const Scene& scene) {
  (void)scene;
  return MakeError(ErrorCode::kUnsupported, "scene validation is not built");
}

}  // namespace lowlap
