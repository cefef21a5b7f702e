#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/geometry/plucker_line.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// A feature of a view: an index into the points or segments of ViewFeatures.
struct FeatureRef {
  ViewId view = kInvalidId;
  FeatureIndex feature = kInvalidId;

  friend bool operator==(const FeatureRef& a, const FeatureRef& b) {
    return a.view == b.view && a.feature == b.feature;
  }
  friend bool operator<(const FeatureRef& a, const FeatureRef& b) {
    return a.view != b.view ? a.view < b.view : a.feature < b.feature;
  }
};

/// Matched observations that are believed to show one point, or one line, of
/// the scene; sorted by view. A point track holds at most one feature of a
/// view; a line track may hold several collinear segments of one.
using Track = std::vector<FeatureRef>;

/// An observation that carries its own pixel, as OpenMVG's structure does; the
/// feature is kInvalidId where no feature file exists.
struct PointObservation {
  ViewId view = kInvalidId;
  FeatureIndex feature = kInvalidId;
  Vec2 pixel_px = Vec2::Zero();

  friend bool operator==(const PointObservation& a, const PointObservation& b) {
    return a.view == b.view && a.feature == b.feature &&
           a.pixel_px == b.pixel_px;
  }
};

/// A triangulated point with its inlier observations, sorted by view.
struct Landmark {
  Vec3 position = Vec3::Zero();  // in world
  std::vector<PointObservation> observations;

  friend bool operator==(const Landmark& a, const Landmark& b) {
    return a.position == b.position && a.observations == b.observations;
  }
};

/// A triangulated line with its inlier observations (segments), and the extent
/// that its segments cover, for display.
struct LineLandmark {
  PluckerLine line;  // in world
  Vec3 start = Vec3::Zero();
  Vec3 end = Vec3::Zero();
  Track observations;

  friend bool operator==(const LineLandmark& a, const LineLandmark& b) {
    return a.line.direction == b.line.direction &&
           a.line.moment == b.line.moment && a.start == b.start &&
           a.end == b.end && a.observations == b.observations;
  }
};

}  // namespace lowlap
