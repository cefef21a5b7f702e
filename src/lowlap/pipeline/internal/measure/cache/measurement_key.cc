#include "lowlap/pipeline/internal/measure/cache/measurement_key.h"

namespace lowlap {
namespace {

template <class... Parts>
void AddAll(Hash128* hash, const Parts&... parts) {
  (hash->Add(parts), ...);
}

// Options are taken apart by structured bindings, so that a new one does not
// compile here until it has become part of the key.

void AddOptions(const PointOptions& options, Hash128* hash) {
  const auto& [max_points, contrast_threshold, edge_threshold] = options;
  AddAll(hash, kPointDetectorVersion, max_points, contrast_threshold,
         edge_threshold);
}

void AddOptions(const LineOptions& options, Hash128* hash) {
  const auto& [min_length_ratio, coarsest_side_px, max_segments] = options;
  AddAll(hash, kLineDetectorVersion, kLineDescriptorVersion, min_length_ratio,
         coarsest_side_px, max_segments);
}

void AddMatcher(PointMatcher matcher, Hash128* hash) {
  if (matcher != PointMatcher::kExact) hash->Add("flann");
}

void AddOptions(const PointMatchOptions& options, Hash128* hash) {
  const auto& [max_ratio, matcher] = options;
  AddAll(hash, kPointMatchingVersion, max_ratio);
  AddMatcher(matcher, hash);
}

void AddOptions(const RelaxedPointOptions& options, Hash128* hash) {
  const auto& [starved_below, max_ratio, matcher, neighbors, min_agreeing,
               max_deviation] = options;
  AddAll(hash, starved_below, max_ratio, neighbors, min_agreeing,
         max_deviation);
  AddMatcher(matcher, hash);
}

void AddOptions(const LineMatchOptions& options, Hash128* hash) {
  const auto& [max_distance_bits, max_candidates, min_score, max_length_ratio] =
      options;
  AddAll(hash, kLineMatchingVersion, max_distance_bits, max_candidates,
         min_score, max_length_ratio);
}

void AddIntrinsic(const Intrinsic& intrinsic, Hash128* hash) {
  AddAll(hash, CameraModelName(intrinsic.model), intrinsic.fx_px,
         intrinsic.fy_px, intrinsic.principal_point_px.x(),
         intrinsic.principal_point_px.y());
  for (const double coefficient : intrinsic.distortion) hash->Add(coefficient);
}

}  // namespace

Hash128::Value FeatureKey(std::string_view image_bytes,
                          const Intrinsic* intrinsic,
                          const FeatureOptions& options) {
  // The memory that may be used has no influence on the result.
  const auto& [detect_points, detect_lines, points, tilts, lines,
               max_memory_gb] = options;
  static_cast<void>(max_memory_gb);
  static_cast<void>(tilts);  // TiltedKey
  Hash128 hash;
  AddAll(&hash, "features", ImageLibraryVersion(), image_bytes, detect_points,
         detect_lines);
  if (detect_points) AddOptions(points, &hash);
  if (detect_lines) {
    AddOptions(lines, &hash);
    const bool straight =
        intrinsic == nullptr || (intrinsic->model != CameraModel::kSpherical &&
                                 !intrinsic->HasDistortion());
    if (!straight) AddIntrinsic(*intrinsic, &hash);
  }
  return hash.value();
}

Hash128::Value TiltedKey(const Hash128::Value& features,
                         const TiltOptions& options) {
  const auto& [max_tilt, max_side_px, max_points] = options;
  Hash128 hash;
  AddAll(&hash, "tilted", kTiltedPointsVersion, features, max_tilt, max_side_px,
         max_points);
  return hash.value();
}

Hash128::Value MatchKey(const Hash128::Value& first,
                        const Hash128::Value& second,
                        const MatchOptions& options) {
  const auto& [match_points, match_lines, points, relaxed_points, tilted_points,
               lines] = options;
  static_cast<void>(tilted_points);  // TiltedMatchKey
  Hash128 hash;
  AddAll(&hash, "matches", first, second, match_points, match_lines);
  if (match_points) {
    AddOptions(points, &hash);
    AddOptions(relaxed_points, &hash);
  }
  if (match_lines) AddOptions(lines, &hash);
  return hash.value();
}

Hash128::Value TiltedMatchKey(const Hash128::Value& first,
                              const Hash128::Value& second,
                              const Hash128::Value& matches,
                              const TiltedPointOptions& options) {
  const auto& [starved_below, enough_pairs, max_partners, max_ratio] = options;
  // Which pairs are matched says nothing of how.
  static_cast<void>(starved_below);
  static_cast<void>(enough_pairs);
  static_cast<void>(max_partners);
  Hash128 hash;
  AddAll(&hash, "tilted matches", kTiltedMatchingVersion, first, second,
         matches, max_ratio);
  return hash.value();
}

}  // namespace lowlap
