#pragma once

#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Where an image should show a landmark, and whether it is found there.
struct ExpectedSighting {
  Vec2 pixel_px = Vec2::Zero();
  bool is_found = false;
};

/// Parts of what two views should both see.
struct OverlapRegions {
  int num = 0;
  int num_bare = 0;  // in which nothing of what is expected is found

  OverlapRegions& operator+=(const OverlapRegions& other) {
    num += other.num;
    num_bare += other.num_bare;
    return *this;
  }
};

/// Divides the image into regions so large that three of the expected landmarks
/// are found in each, at the rate p at which they are found in those that are
/// not bare: halves, across the longer side of their box, down to less than
/// 2 x 3 / p landmarks. p is that of all at first; with the regions that are
/// bare it grows, and the regions become smaller, up to four times. But p is
/// `min_rate` at least, of [0, 1]: what other views find tells more where few
/// landmarks are expected. None if fewer than three are found.
///
/// Where both views see one place, few regions are bare (2 in 100 on
/// photographs), however small p is, as long as it decides; a quarter may be
/// where a third of `min_rate` is found. Where two places look alike in part,
/// all are beside that part. What missing correspondences tell: Zach, Irschara,
/// Bischof, CVPR 2008.
OverlapRegions DivideOverlap(std::vector<ExpectedSighting> expected,
                             double min_rate);

/// That of a region where landmarks are found or not independently of each
/// other, and as many as the regions are made for: e^-3.
inline constexpr double kChanceOfBare = 0.05;

/// log10 of the chance that as many of the regions are bare where the views see
/// one place: the binomial tail for `chance_of_bare` each.
double Log10ChanceOfBare(const OverlapRegions& regions, double chance_of_bare);

}  // namespace lowlap
