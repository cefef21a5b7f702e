#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/internal/validation_parts.h"

namespace lowlap {
namespace {

Status ValidateSupport(const KindSupport& support, const std::string& place) {
  if (support.candidates < 0) {
    return Invalid("must not be negative", place + ".candidates");
  }
  if (support.inliers < 0) {
    return Invalid("must not be negative", place + ".inliers");
  }
  if (support.min_agreeing < 1) {
    return Invalid("must be at least 1", place + ".min_agreeing");
  }
  if (!std::isfinite(support.log10_nfa)) {
    return Invalid("must be finite", place + ".log10_nfa");
  }
  if (!(support.threshold_px >= 0) || !std::isfinite(support.threshold_px)) {
    return Invalid("must be finite and not negative", place + ".threshold_px");
  }
  if (!(support.information_share >= 0) ||
      !std::isfinite(support.information_share)) {
    return Invalid("must be finite and not negative",
                   place + ".information_share");
  }
  return {};
}

Status ValidateScaleRatio(const Scene& scene, const ViewTable& views,
                          const ScaleRatio& ratio, const std::string& place) {
  const auto& [first, middle, last] = ratio.views;
  for (const ViewId view : {first, middle, last}) {
    if (!views.Find(view)) {
      return Invalid(UnknownView(view), place + ".views");
    }
  }
  if (first == last) {
    return Invalid("the three views must differ", place + ".views");
  }
  for (const ViewId neighbour : {first, last}) {
    if (scene.FindRelativePose(neighbour, middle) == nullptr) {
      return Invalid("there is no relative pose of views " +
                         std::to_string(std::min(neighbour, middle).value()) +
                         " and " +
                         std::to_string(std::max(neighbour, middle).value()),
                     place + ".views");
    }
  }
  if (!std::isfinite(ratio.log_ratio)) {
    return Invalid("must be finite", place + ".log_ratio");
  }
  if (!(ratio.log_ratio_stddev >= 0) ||
      !std::isfinite(ratio.log_ratio_stddev)) {
    return Invalid("must be finite and not negative",
                   place + ".log_ratio_stddev");
  }
  if (!std::isfinite(ratio.log10_nfa)) {
    return Invalid("must be finite", place + ".log10_nfa");
  }
  if (ratio.second_mode && (!std::isfinite(ratio.second_mode->log_ratio) ||
                            !std::isfinite(ratio.second_mode->log10_nfa))) {
    return Invalid("must be finite", place + ".second_mode");
  }
  std::set<std::string> kinds;
  for (std::size_t n = 0; n < ratio.kinds.size(); ++n) {
    const KindSupport& support = ratio.kinds[n];
    const std::string of_kind = place + ".kinds" + IndexPlace(n);
    if (support.kind.empty()) {
      return Invalid("must not be empty", of_kind + ".kind");
    }
    if (!kinds.insert(support.kind).second) {
      return Invalid("the kind is listed twice", of_kind);
    }
    LOWLAP_RETURN_IF_ERROR(ValidateSupport(support, of_kind));
  }
  if (ratio.num_rejected_negative < 0) {
    return Invalid("must not be negative", place + ".num_rejected_negative");
  }
  const std::size_t count = views.Find(middle)->segments;
  for (std::size_t n = 0; n < ratio.coplanar_inliers.size(); ++n) {
    const CoplanarInlier& inlier = ratio.coplanar_inliers[n];
    if (inlier.line_in_first >= count || inlier.line_in_last >= count) {
      return Invalid(
          "the middle view has only " + std::to_string(count) + " segments",
          place + ".coplanar_inliers" +
              IndexPlace(2 * n + (inlier.line_in_first < count ? 1 : 0)));
    }
  }
  return {};
}

Status ValidateLandmark(const ViewTable& views, const Landmark& landmark,
                        bool has_features) {
  const auto invalid = [](std::string message, std::string place) {
    return Invalid(std::move(message), std::move(place));
  };
  if (!landmark.position.allFinite()) return invalid("must be finite", ".X");
  const PointObservation* previous = nullptr;
  for (const PointObservation& observation : landmark.observations) {
    const auto place = [&](const char* member) {
      return ".observations[key=" + std::to_string(observation.view.value()) +
             "]" + member;
    };
    const ViewTable::Entry* view = views.Find(observation.view);
    if (!view) {
      return invalid(UnknownView(observation.view), place(""));
    }
    if (previous && !(previous->view < observation.view)) {
      return invalid(previous->view == observation.view
                         ? "the view is observed twice"
                         : "observations must be sorted by view",
                     place(""));
    }
    previous = &observation;
    if (!observation.pixel_px.allFinite()) {
      return invalid("must be finite", place(".x"));
    }
    if (!has_features || observation.feature == kInvalidId) continue;
    if (view->points > 0 && observation.feature >= view->points) {
      return invalid(
          "the view has only " + std::to_string(view->points) + " points",
          place(".id_feat"));
    }
  }
  return {};
}

Status ValidateLine(const ViewTable& views, const LineLandmark& landmark) {
  const PluckerLine& line = landmark.line;
  if (!IsUnit(line.direction)) {
    return Invalid("is not a unit vector", ".direction");
  }
  if (!line.moment.allFinite()) return Invalid("must be finite", ".moment");
  if (!(std::abs(line.moment.dot(line.direction)) <=
        kUnitTolerance * std::max(1.0, line.moment.norm()))) {
    return Invalid("is not orthogonal to the direction", ".moment");
  }
  if (!landmark.start.allFinite()) return Invalid("must be finite", ".start");
  if (!landmark.end.allFinite()) return Invalid("must be finite", ".end");
  return ValidateTrack(views, landmark.observations, FeatureKind::kSegment, {});
}

// Puts the place of the record in front of that of its member.
Status Within(const std::string& record, const Status& status) {
  if (status) return status;
  Error error = status.error();
  error.place = record + error.place;
  return tl::unexpected<Error>(std::move(error));
}

}  // namespace

Status ValidateStructure(const Scene& scene, const ViewTable& views) {
  for (const auto& [id, landmark] : scene.structure) {
    Status status = ValidateLandmark(views, landmark, true);
    if (status && landmark.observations.size() < 2) {
      status = Invalid("needs at least two observations", ".observations");
    }
    if (!status) return Within(ItemPlace("structure", id.value()), status);
  }
  for (const auto& [id, point] : scene.control_points) {
    if (Status status = ValidateLandmark(views, point, false); !status) {
      return Within(ItemPlace("control_points", id), status);
    }
  }
  return {};
}

Status ValidateScaleRatios(const Scene& scene, const ViewTable& views) {
  std::set<std::tuple<ViewId, ViewId, ViewId>> seen;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    const auto& [first, middle, last] = ratio.views;
    const std::string place = OwnItemPlace(
        "scale_ratios", "views",
        std::to_string(first.value()) + "," + std::to_string(middle.value()) +
            "," + std::to_string(last.value()));
    LOWLAP_RETURN_IF_ERROR(ValidateScaleRatio(scene, views, ratio, place));
    // (i, j, k) and (k, j, i) are one triplet.
    if (!seen.emplace(middle, std::min(first, last), std::max(first, last))
             .second) {
      return Invalid("the triplet is listed twice", place);
    }
  }
  return {};
}

Status ValidateLineStructure(const Scene& scene, const ViewTable& views) {
  for (const auto& [id, line] : scene.line_structure) {
    if (Status status = ValidateLine(views, line); !status) {
      return Within(
          OwnItemPlace("line_structure", "id", std::to_string(id.value())),
          status);
    }
  }
  std::set<CoplanarPair> seen;
  for (std::size_t n = 0; n < scene.coplanar_pairs.size(); ++n) {
    const CoplanarPair& pair = scene.coplanar_pairs[n];
    const auto place = [&](std::size_t flat_index) {
      return "$.lowlap.coplanar_pairs" + IndexPlace(flat_index);
    };
    if (scene.line_structure.count(pair.first) == 0) {
      return Invalid("there is no line " + std::to_string(pair.first.value()),
                     place(2 * n));
    }
    if (scene.line_structure.count(pair.second) == 0) {
      return Invalid("there is no line " + std::to_string(pair.second.value()),
                     place(2 * n + 1));
    }
    if (!(pair.first < pair.second)) {
      return Invalid("the first line must have the smaller id", place(2 * n));
    }
    if (!seen.insert(pair).second) {
      return Invalid("the pair is listed twice", place(2 * n));
    }
  }
  return {};
}

}  // namespace lowlap
