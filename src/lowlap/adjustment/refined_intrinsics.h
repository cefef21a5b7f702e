#pragma once

namespace lowlap {

/// Which parts of an intrinsic are unknowns.
struct IntrinsicRefinement {
  bool focal = false;  // fx and fy by one factor
  bool principal_point = false;
  bool distortion = false;
  bool aspect_ratio = false;  // fy / fx

  bool Any() const {
    return focal || principal_point || distortion || aspect_ratio;
  }
};

}  // namespace lowlap
