#pragma once

#include <type_traits>

#include "lowlap/geometry/types.h"
#include "lowlap/scene/intrinsic.h"
#include "lowlap/scene/relative_pose.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

// What the two forms of a record have in common.

/// In the text form: a member that may be missing leaves its value as it is,
/// and if it is an empty list it is not written.
enum class Presence { kAlways, kMayBeMissing };

/// The visitor of a value that is no record.
struct VisitItem {
  template <class Record, class Value>
  void operator()(Record& record, Value& value) const {
    record.Item(value);
  }
};

template <class Value>
using IsEigen = std::is_base_of<Eigen::MatrixBase<Value>, Value>;

inline const char* NameOf(CameraModel model) { return CameraModelName(model); }
inline const char* NameOf(RatioVerdict verdict) {
  return RatioVerdictName(verdict);
}
inline const char* NameOf(PoseWeakness weakness) {
  return PoseWeaknessName(weakness);
}
constexpr CameraModel LastOf(CameraModel) { return CameraModel::kSpherical; }
constexpr RatioVerdict LastOf(RatioVerdict) {
  return RatioVerdict::kNoCandidates;
}
constexpr PoseWeakness LastOf(PoseWeakness) { return PoseWeakness::kRepeats; }

}  // namespace lowlap
