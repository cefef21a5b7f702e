#include "lowlap/adjustment/internal/calibration/calibration_preference.h"

#include <cmath>
#include <utility>

#include "lowlap/adjustment/internal/calibration/calibration_score.h"
#include "lowlap/robust/internal/chi_square.h"

namespace lowlap {
namespace {

constexpr double kFalseAlarms = 0.01;

// The columns of all parts that are wanted, by their places.
template <class Wanted>
std::vector<int> Columns(const CalibrationScore& score, const Wanted& wanted) {
  std::vector<int> columns;
  for (std::size_t n = 0; n < score.parts.size(); ++n) {
    if (wanted(n)) score.parts[n].AddTo(&columns);
  }
  return columns;
}

// By place: noise does not explain the part.
std::vector<char> Choose(const CalibrationScore& score) {
  const std::size_t count = score.parts.size();
  const double level = std::log(kFalseAlarms / static_cast<double>(count));
  std::vector<char> chosen(count, 0);
  for (;;) {
    const std::vector<int> given =
        Columns(score, [&](std::size_t n) { return chosen[n] != 0; });
    std::size_t best = count;
    double least = level;
    for (std::size_t n = 0; n < count; ++n) {
      if (chosen[n] != 0) continue;
      std::vector<int> own;
      score.parts[n].AddTo(&own);
      const double log_tail =
          LogChiSquareTail(score.Statistic(own, given), score.parts[n].size);
      if (log_tail < least) {
        least = log_tail;
        best = n;
      }
    }
    if (best == count) return chosen;
    chosen[best] = 1;
  }
}

// A preference for nothing yet.
CalibrationPreference PreferenceOf(const CalibrationScore::Group& group,
                                   const CameraSet& cameras) {
  CalibrationPreference preference;
  for (const int n : group.intrinsics) {
    preference.intrinsics.push_back(cameras.intrinsics[n].id);
  }
  preference.held = cameras.intrinsics[group.intrinsics.front()].value;
  preference.preferred = preference.held;
  preference.refined = group.refined;
  return preference;
}

}  // namespace

std::vector<CalibrationPreference> FindCalibrationPreferences(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const Scene& scene, const CameraSet& cameras, StructureState state) {
  state.lines.clear();  // what is tied to them is left out of the score
  const auto score = ScoreCalibration(options, noise, scene, cameras, state);
  if (!score) return {};
  const std::vector<char> chosen = Choose(*score);
  const std::vector<int> columns =
      Columns(*score, [&](std::size_t n) { return chosen[n] != 0; });
  if (columns.empty()) return {};
  const Eigen::VectorXd change = score->Change(columns);
  std::vector<CalibrationPreference> preferences;
  for (std::size_t g = 0; g < score->groups.size(); ++g) {
    const auto of_group = [&](std::size_t n) {
      return chosen[n] != 0 && score->parts[n].group == g;
    };
    CalibrationPreference preference = PreferenceOf(score->groups[g], cameras);
    for (std::size_t n = 0; n < score->parts.size(); ++n) {
      if (!of_group(n)) continue;
      const HeldPart& part = score->parts[n];
      preference.parts.*part.part = true;
      if (part.part == &IntrinsicRefinement::distortion) {
        preference.preferred = WithDistortion(preference.preferred);
      }
      ChangePart(part.part, change.segment(part.first, part.size),
                 &preference.preferred);
    }
    if (!preference.parts.Any()) continue;
    preference.deviations = std::sqrt(score->Statistic(
        Columns(*score, of_group), Columns(*score, [&](std::size_t n) {
          return chosen[n] != 0 && !of_group(n);
        })));
    preferences.push_back(std::move(preference));
  }
  return preferences;
}

}  // namespace lowlap
