#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/internal/validation_parts.h"
#include "lowlap/scene/validation.h"

namespace lowlap {
namespace {

Status ValidateRepeated(const std::vector<FeatureIndex>& repeated,
                        std::size_t count, const std::string& place) {
  for (std::size_t n = 0; n < repeated.size(); ++n) {
    if (repeated[n] >= count) {
      return Invalid("the view has only " + std::to_string(count) +
                         " features of this kind",
                     place + IndexPlace(n));
    }
    if (n > 0 && repeated[n] <= repeated[n - 1]) {
      return Invalid("indices must ascend", place + IndexPlace(n));
    }
  }
  return {};
}

// Where the first invalid feature of a view stands in its flat arrays.
Status ValidateViewFeatures(const ViewFeatures& features,
                            const std::string& place) {
  for (std::size_t n = 0; n < features.points_px.size(); ++n) {
    if (!features.points_px[n].allFinite()) {
      return Invalid("point " + std::to_string(n) + " must be finite",
                     place + ".points" + IndexPlace(2 * n));
    }
  }
  const std::vector<Vec3>& shapes = features.point_covariances;
  if (!shapes.empty() && shapes.size() != features.points_px.size()) {
    return Invalid("there must be one per point, or none",
                   place + ".point_covariances");
  }
  for (std::size_t n = 0; n < shapes.size(); ++n) {
    const Vec3& shape = shapes[n];
    if (!shape.allFinite() || !(shape(0) > 0) || !(shape(2) > 0) ||
        !(shape(0) * shape(2) > shape(1) * shape(1))) {
      return Invalid("the covariance of point " + std::to_string(n) +
                         " must be finite and positive definite",
                     place + ".point_covariances" + IndexPlace(3 * n));
    }
  }
  for (std::size_t n = 0; n < features.segments.size(); ++n) {
    const LineSegment& segment = features.segments[n];
    const std::string segment_place = ".segments" + IndexPlace(5 * n);
    if (!segment.start_px.allFinite() || !segment.end_px.allFinite()) {
      return Invalid("segment " + std::to_string(n) + " must be finite",
                     place + segment_place);
    }
    if (!(segment.stddev_px >= 0) || !std::isfinite(segment.stddev_px)) {
      return Invalid("the standard deviation of segment " + std::to_string(n) +
                         " must be finite and not negative",
                     place + ".segments" + IndexPlace(5 * n + 4));
    }
  }
  LOWLAP_RETURN_IF_ERROR(ValidateRepeated(features.repeated_points,
                                          features.points_px.size(),
                                          place + ".repeated_points"));
  return ValidateRepeated(features.repeated_segments, features.segments.size(),
                          place + ".repeated_segments");
}

Status ValidateMatches(const std::vector<FeatureMatch>& matches,
                       std::size_t first_count, std::size_t second_count,
                       const std::string& place) {
  for (std::size_t n = 0; n < matches.size(); ++n) {
    if (matches[n].first >= first_count) {
      return Invalid("the first view has only " + std::to_string(first_count) +
                         " features of this kind",
                     place + IndexPlace(2 * n));
    }
    if (matches[n].second >= second_count) {
      return Invalid("the second view has only " +
                         std::to_string(second_count) +
                         " features of this kind",
                     place + IndexPlace(2 * n + 1));
    }
  }
  return {};
}

// Of a relative pose, or of an alternative to it.
template <class Motion>
Status ValidateMotion(const Motion& motion, const std::string& place) {
  if (!(RotationDefect(motion.rotation) <= kUnitTolerance)) {
    return Invalid("is not a rotation matrix", place + ".rotation");
  }
  if (!IsUnit(motion.direction)) {
    return Invalid("is not a unit vector", place + ".direction");
  }
  if (!std::isfinite(motion.log10_nfa)) {
    return Invalid("must be finite", place + ".log10_nfa");
  }
  if (motion.covariance && !IsCovariance(*motion.covariance)) {
    return Invalid(kNoCovariance, place + ".covariance");
  }
  return {};
}

Status ValidateRelativePose(const ViewTable& views, const RelativePose& edge,
                            const std::string& place) {
  const ViewTable::Entry* first = views.Find(edge.views.first);
  const ViewTable::Entry* second = views.Find(edge.views.second);
  if (!first || !second) {
    return Invalid(UnknownView(first ? edge.views.second : edge.views.first),
                   place + ".views");
  }
  if (!(edge.views.first < edge.views.second)) {
    return Invalid("the first view must have the smaller id", place + ".views");
  }
  LOWLAP_RETURN_IF_ERROR(ValidateMotion(edge, place));
  for (std::size_t n = 0; n < edge.alternatives.size(); ++n) {
    LOWLAP_RETURN_IF_ERROR(ValidateMotion(
        edge.alternatives[n], place + ".alternatives" + IndexPlace(n)));
  }
  if (!(edge.point_threshold_px >= 0) ||
      !std::isfinite(edge.point_threshold_px)) {
    return Invalid("must be finite and not negative",
                   place + ".point_threshold_px");
  }
  LOWLAP_RETURN_IF_ERROR(ValidateMatches(edge.point_inliers, first->points,
                                         second->points,
                                         place + ".point_inliers"));
  return ValidateMatches(edge.line_inliers, first->segments, second->segments,
                         place + ".line_inliers");
}

}  // namespace

}  // namespace lowlap

namespace lowlap {

Status ValidateRelativePose(const RelativePose& pose) {
  LOWLAP_RETURN_IF_ERROR(ValidateMotion(pose, {}));
  for (const AlternativeMotion& other : pose.alternatives) {
    LOWLAP_RETURN_IF_ERROR(ValidateMotion(other, {}));
  }
  return {};
}

}  // namespace lowlap

namespace lowlap {

Status ValidateFeatures(const Scene& scene, const ViewTable& views) {
  for (const auto& [view, features] : scene.features) {
    const std::string place =
        OwnItemPlace("features", "view", std::to_string(view.value()));
    if (!views.Find(view)) return Invalid(UnknownView(view), place);
    LOWLAP_RETURN_IF_ERROR(ValidateViewFeatures(features, place));
  }
  return {};
}

Status ValidateRelativePoses(const Scene& scene, const ViewTable& views) {
  for (const auto& [pair, edge] : scene.relative_poses) {
    const std::string place =
        OwnItemPlace("relative_poses", "views",
                     std::to_string(pair.first.value()) + "," +
                         std::to_string(pair.second.value()));
    if (pair != edge.views) {
      return Invalid("is stored under other views than its own",
                     place + ".views");
    }
    LOWLAP_RETURN_IF_ERROR(ValidateRelativePose(views, edge, place));
  }
  return {};
}

Status ValidateUnrelatedPairs(const Scene& scene, const ViewTable& views) {
  const std::vector<ViewPair>& pairs = scene.unrelated_pairs;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    const auto& [first, second] = pairs[n];
    const std::string place = "$.lowlap.unrelated_pairs" + IndexPlace(2 * n);
    for (const ViewId view : {first, second}) {
      if (!views.Find(view)) return Invalid(UnknownView(view), place);
    }
    if (!(first < second)) {
      return Invalid("the first view must have the smaller id", place);
    }
    if (n > 0 && !(pairs[n - 1] < pairs[n])) {
      return Invalid("pairs must ascend", place);
    }
    if (scene.relative_poses.count(pairs[n]) > 0) {
      return Invalid("the pair has a relative pose", place);
    }
  }
  return {};
}

Status ValidateTrack(const ViewTable& views, const Track& track,
                     FeatureKind kind, const std::string& place) {
  const auto invalid = [&](std::string message, std::size_t flat_index) {
    return Invalid(std::move(message),
                   place + ".observations" + IndexPlace(flat_index));
  };
  if (track.size() < 2) {
    return Invalid("needs at least two observations", place + ".observations");
  }
  bool ascending = true;
  for (std::size_t n = 0; n < track.size(); ++n) {
    const FeatureRef& ref = track[n];
    const ViewTable::Entry* view = views.Find(ref.view);
    if (!view) return invalid(UnknownView(ref.view), 2 * n);
    const std::size_t count =
        kind == FeatureKind::kPoint ? view->points : view->segments;
    if (ref.feature >= count) {
      return invalid("view " + std::to_string(ref.view.value()) + " has only " +
                         std::to_string(count) + " features of this kind",
                     2 * n + 1);
    }
    if (n == 0 || track[n - 1].view < ref.view) continue;
    if (ref.view < track[n - 1].view) {
      return invalid("observations must be sorted by view", 2 * n);
    }
    if (kind == FeatureKind::kPoint) {
      return invalid("view " + std::to_string(ref.view.value()) +
                         " appears twice in one track",
                     2 * n);
    }
    ascending = ascending && track[n - 1].feature < ref.feature;
  }
  if (!ascending) {
    Track sorted = track;
    std::sort(sorted.begin(), sorted.end());
    const auto repeated = std::adjacent_find(sorted.begin(), sorted.end());
    if (repeated != sorted.end()) {
      return Invalid("segment " + std::to_string(repeated->feature) +
                         " of view " + std::to_string(repeated->view.value()) +
                         " is repeated",
                     place + ".observations");
    }
  }
  return {};
}

Status ValidateTracks(const Scene& scene, const ViewTable& views) {
  const auto validate = [&](const auto& tracks, const char* section,
                            FeatureKind kind) -> Status {
    for (const auto& [id, track] : tracks) {
      // The place is spelt out only on failure: scenes have many tracks.
      if (Status status = ValidateTrack(views, track, kind, {}); !status) {
        Error error = status.error();
        error.place = OwnItemPlace(section, "id", std::to_string(id.value())) +
                      error.place;
        return tl::unexpected<Error>(std::move(error));
      }
    }
    return {};
  };
  LOWLAP_RETURN_IF_ERROR(
      validate(scene.point_tracks, "point_tracks", FeatureKind::kPoint));
  return validate(scene.line_tracks, "line_tracks", FeatureKind::kSegment);
}

}  // namespace lowlap
