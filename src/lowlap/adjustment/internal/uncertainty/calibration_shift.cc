#include "lowlap/adjustment/internal/uncertainty/calibration_shift.h"

#include <algorithm>

#include "lowlap/adjustment/internal/calibration/focal_at_stake.h"
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

// Whether anything moves.
bool MoveIntrinsics(const std::vector<CalibrationPreference>& preferences,
                    const std::vector<double>& focal_factors,
                    std::vector<IntrinsicState>* intrinsics) {
  bool moved = false;
  for (std::size_t n = 0; n < intrinsics->size(); ++n) {
    IntrinsicState& intrinsic = (*intrinsics)[n];
    const auto preference =
        std::find_if(preferences.begin(), preferences.end(),
                     [&](const CalibrationPreference& p) {
                       return std::count(p.intrinsics.begin(),
                                         p.intrinsics.end(), intrinsic.id) > 0;
                     });
    if (preference != preferences.end()) {
      Change(*preference, &intrinsic.value);
    } else if (focal_factors[n] != 1) {
      intrinsic.value.fx_px *= focal_factors[n];
      intrinsic.value.fy_px *= focal_factors[n];
    } else {
      continue;
    }
    intrinsic.ParametersFromValue();
    moved = true;
  }
  return moved;
}

}  // namespace

Status AddCalibrationShift(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const std::vector<CalibrationPreference>& preferences, const Scene& scene,
    const RunContext& context, const CameraSet& cameras, StructureState state,
    CenterUncertainty* uncertainty) {
  CameraSet moved = cameras;
  if (!MoveIntrinsics(
          preferences,
          FocalFactorsAtStake(options, noise, scene, cameras, state),
          &moved.intrinsics)) {
    return {};
  }
  const std::vector<Component> components =
      FindComponents(cameras, state, SelectForSolve(cameras, state, options));
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
