#pragma once

#include "lowlap/core/result.h"

namespace lowlap {

// Matching under a known relative pose.

struct GuidedPointOptions {
  /// A match must be closer than this times the next candidate that lies
  /// elsewhere, and than this times the nearest of `chance_points` points of
  /// the other image that no geometry prefers.
  double max_ratio = 0.85;
  int chance_points = 256;
  /// Greatest factor between the blob's change of size and the one that its
  /// depths predict, and greatest angle between its orientation and the
  /// predicted one: the slant of a surface changes both.
  double max_scale_factor = 2.0;
  double max_turn_deg = 40.0;

  Status Validate() const;
};

struct GuidedLineOptions {
  /// Greatest Hamming distance of two descriptors of 256 bits; the geometry
  /// leaves few partners, so this may be wider than without it.
  int max_distance_bits = 110;
  /// Least overlap of two segments along the line, after transfer by the
  /// epipolar lines of the end points, relative to the shorter of the two.
  double min_overlap = 0.5;
  /// A line closer than this to an epipolar plane has no depth, and the
  /// transfer of its end points says nothing: no match.
  double min_epipolar_angle_deg = 1.0;
  /// By how much the epipolar lines of a pose may be off, in pixels.
  double epipolar_tolerance_px = 2.0;
  /// Least score of a match, in [0, 1].
  double min_score = 0.07;

  Status Validate() const;
};

struct LineFilterOptions {
  /// Least overlap of the two segments along the line, after transfer by the
  /// epipolar lines of the end points, relative to the shorter of the two.
  double min_overlap = 0.5;
  /// A line closer than this to an epipolar plane has no depth: it is dropped.
  double min_epipolar_angle_deg = 2.0;

  Status Validate() const;
};

}  // namespace lowlap
