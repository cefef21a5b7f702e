#pragma once

#include "lowlap/core/result.h"

namespace lowlap {

struct PointOptions {
  /// Keypoints kept per image. More of them help thin overlaps and cost
  /// quadratic matching time.
  int max_points = 12000;
  /// Least contrast of a blob, as in Lowe 2004 (grey values in [0, 1],
  /// divided by the number of scales per octave).
  double contrast_threshold = 0.007;
  /// Greatest ratio of principal curvatures.
  double edge_threshold = 10.0;

  Status Validate() const;
};

/// Images compressed along one direction, as surfaces appear in them that are
/// turned away (DetectTiltedPoints).
struct TiltOptions {
  double max_tilt = 4;  // greatest compression; 1: none
  /// Larger images are reduced for it.
  int max_side_px = 1300;
  /// Keypoints kept per tilted image, of which there are two dozen.
  int max_points = 1000;

  Status Validate() const;
};

struct LineOptions {
  /// Shorter segments are dropped; relative to (width + height) / 2.
  double min_length_ratio = 0.015;
  /// The pyramid is halved until the longer side is at most this.
  int coarsest_side_px = 1000;
  /// At most this many segments, the longest.
  int max_segments = 5000;

  Status Validate() const;
};

struct FeatureOptions {
  bool detect_points = true;
  bool detect_lines = true;
  PointOptions points;
  TiltOptions tilts;
  LineOptions lines;
  /// Images are processed in parallel only as far as this reaches: SIFT's scale
  /// space takes about 240 bytes per pixel (1.5 GB for 6 megapixels).
  double max_memory_gb = 3.5;

  Status Validate() const;
};

}  // namespace lowlap
