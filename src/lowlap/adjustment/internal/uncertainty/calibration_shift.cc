#include "lowlap/adjustment/internal/uncertainty/calibration_shift.h"

#include <algorithm>

#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/adjustment/internal/rounds/solve.h"
#include "lowlap/adjustment/internal/uncertainty/center_shift.h"

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
  CenterShift(cameras, components, moved).AddTo(uncertainty);
  return {};
}

}  // namespace lowlap
