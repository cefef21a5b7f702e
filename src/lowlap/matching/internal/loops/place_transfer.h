#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Where places of one photograph lie in another, as matches near them tell.
class PlaceTransfer {
 public:
  struct Match {
    Vec2 from_px = Vec2::Zero();
    Vec2 to_px = Vec2::Zero();
  };

  /// `radius_px` > 0: how far off a match still tells something of a place.
  PlaceTransfer(const std::vector<Match>& matches, double radius_px);

  /// The place moved as the nearest matches within the radius move, at most
  /// three of them (the median of each coordinate); none if there is no match,
  /// or the place is not finite. O(matches within the radius).
  std::optional<Vec2> Apply(const Vec2& place_px) const;

 private:
  // Rows first, so that neighbours in a row follow each other.
  using Cell = std::pair<std::int64_t, std::int64_t>;
  struct Entry {
    Cell cell;
    Match match;
  };
  Cell CellOf(const Vec2& place_px) const;

  double radius_px_;
  std::vector<Entry> entries_;  // sorted by cells of the size of the radius
};

}  // namespace lowlap
