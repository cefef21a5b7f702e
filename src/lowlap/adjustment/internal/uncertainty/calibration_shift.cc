#include "lowlap/adjustment/internal/uncertainty/calibration_shift.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/adjustment/internal/rounds/solve.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/similarity.h"

namespace lowlap {
namespace {

constexpr double kTolerance = 1e-4;

// As the images prefer the first intrinsic of the preference.
void Change(const CalibrationPreference& preference, Intrinsic* intrinsic) {
  const Intrinsic& held = preference.held;
  const Intrinsic& preferred = preference.preferred;
  intrinsic->fx_px *= preferred.fx_px / held.fx_px;
  intrinsic->fy_px *= preferred.fy_px / held.fy_px;
  intrinsic->principal_point_px +=
      intrinsic->ImageDiagonal() / held.ImageDiagonal() *
      (preferred.principal_point_px - held.principal_point_px);
  if (intrinsic->model == CameraModel::kPinhole) {
    intrinsic->model = preferred.model;
    intrinsic->distortion.resize(preferred.distortion.size(), 0);
  }
  const std::size_t size =
      std::min(intrinsic->distortion.size(), preferred.distortion.size());
  for (std::size_t n = 0; n < size; ++n) {
    intrinsic->distortion[n] +=
        preferred.distortion[n] -
        (n < held.distortion.size() ? held.distortion[n] : 0);
  }
}

CameraSet WithPreferences(const std::vector<CalibrationPreference>& preferences,
                          CameraSet cameras) {
  for (const CalibrationPreference& preference : preferences) {
    for (IntrinsicState& intrinsic : cameras.intrinsics) {
      if (std::count(preference.intrinsics.begin(), preference.intrinsics.end(),
                     intrinsic.id) == 0) {
        continue;
      }
      Change(preference, &intrinsic.value);
      intrinsic.ParametersFromValue();
    }
  }
  return cameras;
}

using Centers = std::map<PoseId, Vec3>;

// What moved, in the frame before. Empty where there is no one frame.
Centers MovedBack(const Component& component, const CameraSet& before,
                  const CameraSet& after) {
  std::vector<Vec3> source, target;
  for (const int pose : component.poses) {
    source.push_back(after.poses[pose].center);
    target.push_back(before.poses[pose].center);
  }
  Centers centers;
  const auto similarity = AlignPoints(source, target);
  if (!similarity) return centers;
  for (std::size_t n = 0; n < source.size(); ++n) {
    centers[before.poses[component.poses[n]].id] = *similarity * source[n];
  }
  return centers;
}

double LogRatio(const Vec3& first, const Vec3& middle, const Vec3& last) {
  return std::log((last - middle).norm() / (middle - first).norm());
}

// The centres of one component before, and those that moved.
class Shift {
 public:
  Shift(const CameraSet& cameras, const Centers& moved)
      : cameras_(cameras), moved_(moved) {}

  void AddTo(CenterUncertainty* uncertainty) const {
    for (const PoseState& pose : cameras_.poses) {
      const auto moved = moved_.find(pose.id);
      const auto stated = uncertainty->covariances.find(pose.id);
      if (moved == moved_.end() || stated == uncertainty->covariances.end()) {
        continue;
      }
      const double square = (moved->second - pose.center).squaredNorm();
      stated->second += square / 3 * Mat3::Identity();
    }
    for (auto& [views, stddev] : uncertainty->log_ratio_stddevs) {
      if (!Has(views.first) || !Has(views.middle) || !Has(views.last)) continue;
      const double change =
          LogRatio(After(views.first), After(views.middle), After(views.last)) -
          LogRatio(Before(views.first), Before(views.middle),
                   Before(views.last));
      if (std::isfinite(change)) stddev = std::hypot(stddev, change);
    }
    for (auto& [views, stddev_rad] : uncertainty->direction_stddevs_rad) {
      if (!Has(views.first) || !Has(views.second)) continue;
      const double change_rad =
          AngleBetween(After(views.second) - After(views.first),
                       Before(views.second) - Before(views.first));
      if (std::isfinite(change_rad)) {
        stddev_rad = std::hypot(stddev_rad, change_rad);
      }
    }
  }

 private:
  const PoseState& PoseOf(ViewId view) const {
    return cameras_.PoseOf(cameras_.Find(view));
  }
  bool Has(ViewId view) const { return moved_.count(PoseOf(view).id) > 0; }
  const Vec3& Before(ViewId view) const { return PoseOf(view).center; }
  const Vec3& After(ViewId view) const { return moved_.at(PoseOf(view).id); }

  const CameraSet& cameras_;
  const Centers& moved_;
};

}  // namespace

Status AddCalibrationShift(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const std::vector<CalibrationPreference>& preferences, const Scene& scene,
    const RunContext& context, const CameraSet& cameras, StructureState state,
    CenterUncertainty* uncertainty) {
  if (preferences.empty()) return {};
  const std::vector<Component> components =
      FindComponents(cameras, state, SelectForSolve(cameras, state, options));
  CameraSet moved = WithPreferences(preferences, cameras);
  // Directions are those of the calibration that is held.
  state.directions.clear();
  RefreshRays(scene, moved, &state);
  const auto solved =
      SolveOnce(options, {"preferred calibration", false, kTolerance, noise},
                context, &moved, &state);
  if (!solved) {
    return solved.error().code == ErrorCode::kCancelled
               ? tl::unexpected<Error>(solved.error())
               : Status();
  }
  for (const Component& component : components) {
    const Centers centers = MovedBack(component, cameras, moved);
    Shift(cameras, centers).AddTo(uncertainty);
  }
  return {};
}

}  // namespace lowlap
