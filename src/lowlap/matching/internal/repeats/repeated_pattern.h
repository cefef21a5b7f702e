#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/geometry/types.h"
#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "lowlap/matching/internal/repeats/conjugate_translation.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// What of one photograph is a pattern that repeats on a plane: the tiles of a
/// floor, the windows of a facade, goods in a shelf. Where a match of one copy
/// is right, the match of the next copy would be just as good.
class RepeatedPattern {
 public:
  /// Nothing repeats.
  RepeatedPattern() = default;

  /// Translations within planes that take points of the photograph to others
  /// that look alike, one after the other, while they are meaningful
  /// (TranslationSearch): the points that they take and those they take them
  /// to. An edge that looks alike all along is none: partners drawn at random
  /// fit it as well. Of many points those of the largest scales are looked at
  /// for translations; all, for whether these take them to their like
  /// (FindCopiedPoints). Panoramas, and points at infinity, have no patterns.
  static RepeatedPattern Find(const PointView& view);

  bool IsEmpty() const { return members_.empty(); }
  /// Of the view that it was found in: whether the pattern covers its point, or
  /// the point has a copy.
  bool HasPoint(FeatureIndex point) const {
    return !IsEmpty() && has_point_[point];
  }
  /// Whether the pattern covers both ends of a segment.
  bool HasSegment(const NormalizedSegment& segment) const;
  /// Whether a point at `x` (z = 1) of the scale `scale_px` belongs to the
  /// pattern: a point of the pattern and it lie in each other's windows, so
  /// that both show much of the same.
  bool Covers(const Vec3& x, double scale_px) const;
  /// Whether one of its translations, up to three times either way, takes the
  /// place x (z = 1) to within `tolerance_px` of `other`.
  bool AreCopies(const Vec3& x, const Vec3& other, double tolerance_px) const;

 private:
  struct Member {
    Vec2 place_px = Vec2::Zero();  // from the principal point, undistorted
    double scale_px = 0;
  };
  double focal_px_ = 1;
  std::vector<ConjugateTranslation> translations_;
  std::vector<Member> members_;
  std::vector<bool> has_point_;
};

}  // namespace lowlap
