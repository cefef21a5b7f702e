#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Two places of one photograph that look alike, as rays with z = 1.
struct AlikePlaces {
  int first = 0;  // indices of the points
  int second = 0;
  Vec3 from = Vec3::UnitZ();
  Vec3 to = Vec3::UnitZ();
  double tolerance = 0;  // of `to`, in the same units
};

/// What a translation within a plane of the scene makes of its image,
///   x' ~ (I + v l^T) x,  l . v = 0,
/// l the vanishing line of the plane (|l| = 1), v the vanishing point of the
/// translation times its length (Schaffalitzky, Zisserman, "Planar grouping for
/// automatic detection of vanishing lines and points", 2000).
struct ConjugateTranslation {
  Vec3 vanishing_point = Vec3::Zero();
  Vec3 vanishing_line = Vec3::UnitZ();

  /// The image of a ray, with z = 1; nullopt for what goes behind the camera.
  std::optional<Vec3> Map(const Vec3& x) const;
  /// Whether it takes `from` to within the tolerance of `to`.
  bool Explains(const AlikePlaces& places) const;

  /// The one that takes a.from to a.to and b.from to b.to. nullopt where all
  /// four lie on one line, or the places are not distinct.
  static std::optional<ConjugateTranslation> FromTwo(const AlikePlaces& a,
                                                     const AlikePlaces& b);

  /// The one within a plane of this vanishing line that takes places.from to
  /// places.to; nullopt for places on the line.
  static std::optional<ConjugateTranslation> FromOne(
      const AlikePlaces& places, const Vec3& vanishing_line);

  /// One Gauss-Newton step on those of the first `most` places that it explains
  /// within `tolerance_factor` of their tolerance; nullopt if they are too few.
  std::optional<ConjugateTranslation> Refined(
      const std::vector<AlikePlaces>& places, std::size_t most,
      double tolerance_factor) const;
};

}  // namespace lowlap
