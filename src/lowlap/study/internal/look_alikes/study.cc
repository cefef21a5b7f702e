#include "lowlap/study/internal/look_alikes/study.h"

#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/features/internal/points/tilted_points.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/matching/internal/points/tilted_matching.h"
#include "lowlap/matching/internal/starved_pairs.h"
#include "lowlap/study/internal/run_trials.h"
#include "lowlap/two_view/internal/pair_estimator.h"

namespace lowlap {
namespace {

constexpr double kRightDeg = 2;

// The point matches as `lowlap run` finds them. Starved pairs add points.
Status MatchAgainFromAside(const std::array<GrayImage, 2>& images,
                           std::array<DetectedFeatures, 2>* detected,
                           PairMatches* matches) {
  const MatchOptions options;
  const std::map<ViewPair, PairMatches> pair = {
      {{ViewId(0), ViewId(1)}, *matches}};
  if (SelectStarvedPairs(pair, options.tilted_points).empty()) return {};
  std::array<TiltedPoints, 2> tilted;
  for (std::size_t n = 0; n < 2; ++n) {
    DetectedFeatures& features = (*detected)[n];
    RunContext serial;
    serial.num_threads = 1;
    LOWLAP_ASSIGN_OR_RETURN(
        tilted[n],
        DetectTiltedPoints(images[n],
                           {features.keypoints, features.point_descriptors},
                           PointOptions(), TiltOptions(), serial));
    AddPoints(tilted[n].added, &features);
  }
  matches->points =
      MatchTiltedPoints({(*detected)[0].keypoints, tilted[0].looks},
                        {(*detected)[1].keypoints, tilted[1].looks},
                        matches->points, options.tilted_points);
  return {};
}

Result<PairEstimate> EstimatePairOf(const PhotographPair& photographs,
                                    std::uint64_t seed) {
  std::array<DetectedFeatures, 2> detected;
  for (std::size_t n = 0; n < 2; ++n) {
    LOWLAP_ASSIGN_OR_RETURN(
        detected[n], DetectFeatures(photographs.images[n], FeatureOptions()));
  }
  PairMatches matches = MatchPair(detected[0], detected[1], MatchOptions());
  LOWLAP_RETURN_IF_ERROR(
      MatchAgainFromAside(photographs.images, &detected, &matches));
  std::array<ViewMeasurements, 2> views;
  for (std::size_t n = 0; n < 2; ++n) {
    const Intrinsic& intrinsic = photographs.intrinsic;
    views[n] = MeasureView(detected[n].features, intrinsic,
                           Vec2(intrinsic.width_px, intrinsic.height_px),
                           &detected[n], VanishingOptions());
  }
  return EstimatePair({ViewId(0), ViewId(1)}, views[0], views[1], matches,
                      PairOptions(), seed);
}

std::optional<LookAlikeTrial> RunTrial(const LookAlikeKey& key) {
  const auto& [kind, is_same_place, seed] = key;
  const PhotographPair photographs =
      MakePhotographPair(kind, is_same_place, seed);
  LookAlikeTrial trial;
  const auto estimated = EstimatePairOf(photographs, seed);
  if (!estimated) {
    trial.reason = estimated.error().message;
    return trial;
  }
  const PairEstimate& estimate = *estimated;
  trial.is_accepted = estimate.pose.has_value();
  trial.reason = estimate.reason;
  if (!trial.is_accepted) return trial;
  trial.log10_nfa = estimate.pose->log10_nfa;
  if (is_same_place) {
    const RigidTransform& truth = photographs.cam2_from_cam1;
    trial.rotation_error_deg = DegFromRad(
        RotationAngleBetween(estimate.pose->rotation, truth.rotation));
    trial.direction_error_deg =
        DegFromRad(AngleBetween(estimate.pose->direction, truth.translation));
  }
  return trial;
}

std::string OfHow(int count, int total) {
  return std::to_string(count) + " of " + std::to_string(total);
}

std::string PairsCsv(const LookAlikeStudy& study) {
  TextTable table;
  table.columns = {"kind",
                   "same_place",
                   "seed",
                   "accepted",
                   "log10_nfa",
                   "rotation_error_deg",
                   "direction_error_deg",
                   "reason"};
  for (const auto& [key, trial] : study.trials) {
    const auto& [kind, is_same_place, seed] = key;
    const bool is_judged = is_same_place && trial.is_accepted;
    table.rows.push_back(
        {RepeatedKindName(kind), is_same_place ? "1" : "0",
         std::to_string(seed), trial.is_accepted ? "1" : "0",
         trial.is_accepted ? NumberText(trial.log10_nfa, 6) : "",
         is_judged ? NumberText(trial.rotation_error_deg, 6) : "",
         is_judged ? NumberText(trial.direction_error_deg, 6) : "",
         trial.reason});
  }
  return ToCsv(table);
}

}  // namespace

Status RunLookAlikeStudy(
    const RunContext& context,
    const std::function<Status(const LookAlikeKey&, const LookAlikeTrial&)>&
        done,
    LookAlikeStudy* study) {
  if (study->num_pairs < 1) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the number of pairs must be positive");
  }
  std::vector<LookAlikeKey> missing;
  // A study that is stopped has seen as many of each kind.
  for (const bool is_same_place : {false, true}) {
    for (int n = 0; n < study->num_pairs; ++n) {
      for (const RepeatedKind kind : kRepeatedKinds) {
        const LookAlikeKey key = {kind, is_same_place,
                                  context.seed + static_cast<std::uint64_t>(n)};
        if (study->trials.count(key) == 0) missing.push_back(key);
      }
    }
  }
  return RunTrials<LookAlikeKey, LookAlikeTrial>(
      context, "photographing", missing, RunTrial, done, &study->trials);
}

TextTable LookAlikeTable(const LookAlikeStudy& study) {
  TextTable table;
  table.columns = {"what repeats", "different places: accepted",
                   "one place: accepted", "of these within 2 degrees"};
  for (const RepeatedKind kind : kRepeatedKinds) {
    int pairs[2] = {0, 0}, accepted[2] = {0, 0}, right = 0;
    for (const auto& [key, trial] : study.trials) {
      if (std::get<0>(key) != kind) continue;
      const int same = std::get<1>(key) ? 1 : 0;
      ++pairs[same];
      accepted[same] += trial.is_accepted ? 1 : 0;
      right +=
          same == 1 && trial.is_accepted && trial.rotation_error_deg < kRightDeg
              ? 1
              : 0;
    }
    table.rows.push_back({RepeatedKindName(kind), OfHow(accepted[0], pairs[0]),
                          OfHow(accepted[1], pairs[1]), std::to_string(right)});
  }
  return table;
}

std::vector<std::pair<std::string, std::string>> LookAlikeFiles(
    const LookAlikeStudy& study) {
  return {{"pairs.csv", PairsCsv(study)},
          {"summary.txt", ToAlignedText(LookAlikeTable(study))}};
}

}  // namespace lowlap
