#include "lowlap/features/internal/lines/midpoint_grid.h"

#include <algorithm>
#include <cmath>

namespace lowlap {
namespace {

constexpr double kCellSize = 32;
// Cells a side at most; those at the border take what lies beyond.
constexpr double kMaxCells = 1024;

std::size_t CellCount(double extent) {
  return static_cast<std::size_t>(
      std::clamp(std::ceil(extent / kCellSize), 1.0, kMaxCells));
}

std::size_t CellOf(double offset, std::size_t count) {
  return static_cast<std::size_t>(std::clamp(
      std::floor(offset / kCellSize), 0.0, static_cast<double>(count - 1)));
}

}  // namespace

MidpointGrid::MidpointGrid(const Vec2& low, const Vec2& high)
    : low_(low),
      num_columns_(CellCount(high.x() - low.x())),
      num_rows_(CellCount(high.y() - low.y())),
      cells_(num_columns_ * num_rows_) {}

std::size_t MidpointGrid::Column(double x) const {
  return CellOf(x - low_.x(), num_columns_);
}

std::size_t MidpointGrid::Row(double y) const {
  return CellOf(y - low_.y(), num_rows_);
}

void MidpointGrid::Insert(std::size_t id, const Vec2& midpoint) {
  cells_[Row(midpoint.y()) * num_columns_ + Column(midpoint.x())].push_back(id);
}

std::vector<std::size_t> MidpointGrid::Near(const Vec2& start, const Vec2& end,
                                            double reach) const {
  const Vec2& upper = start.y() <= end.y() ? start : end;
  const Vec2& lower = start.y() <= end.y() ? end : start;
  const Vec2 run = lower - upper;
  // Where the segment is at a height, held to its ends.
  const auto x_at = [&](double y) {
    return upper.x() +
           std::clamp((y - upper.y()) / run.y(), 0.0, 1.0) * run.x();
  };
  std::vector<std::size_t> ids;
  const std::size_t first_row = Row(upper.y() - reach);
  const std::size_t last_row = Row(lower.y() + reach);
  for (std::size_t row = first_row; row <= last_row; ++row) {
    // The part of the segment within reach of this row of cells; the outer
    // rows go on for ever.
    const double top = row == 0 ? -INFINITY : low_.y() + row * kCellSize;
    const double bottom =
        row + 1 == num_rows_ ? INFINITY : low_.y() + (row + 1) * kCellSize;
    double left = upper.x(), right = lower.x();
    if (run.y() > 0) {
      left = x_at(top - reach);
      right = x_at(bottom + reach);
    }
    if (left > right) std::swap(left, right);
    const std::size_t last = Column(right + reach);
    for (std::size_t column = Column(left - reach); column <= last; ++column) {
      const std::vector<std::size_t>& cell =
          cells_[row * num_columns_ + column];
      ids.insert(ids.end(), cell.begin(), cell.end());
    }
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace lowlap
