#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Finds segments by their midpoints: a uniform grid over the box from `low`
/// to `high`, whose border cells also hold what lies outside.
class MidpointGrid {
 public:
  MidpointGrid(const Vec2& low, const Vec2& high);

  void Insert(std::size_t id, const Vec2& midpoint);

  /// Ascending ids of all midpoints closer than `reach` to the segment from
  /// `start` to `end`, and of others in the same cells.
  std::vector<std::size_t> Near(const Vec2& start, const Vec2& end,
                                double reach) const;

 private:
  std::size_t Column(double x) const;
  std::size_t Row(double y) const;

  Vec2 low_;
  std::size_t num_columns_;
  std::size_t num_rows_;
  std::vector<std::vector<std::size_t>> cells_;
};

}  // namespace lowlap
