#include "lowlap/scale/evidence/internal/disc_index.h"

#include <algorithm>
#include <cmath>

namespace lowlap {
namespace {

// Cells beside the query's are as far as this allows for rounding.
constexpr double kDistanceRounding = 1e-9;
// Queries far outside a grid keep integers in range.
constexpr double kFarthest = 1e6;

int CellOf(double offset, double cell) {
  return static_cast<int>(
      std::floor(std::clamp(offset / cell, -kFarthest, kFarthest)));
}

}  // namespace

int DiscIndex::Grid::ColumnOf(double x) const {
  return CellOf(x - low_x, cell);
}

int DiscIndex::Grid::RowOf(double y) const { return CellOf(y - low_y, cell); }

DiscIndex::DiscIndex(std::vector<Disc> discs) : discs_(std::move(discs)) {
  constexpr int kOctaves = 12;
  double largest = 0;
  std::vector<int> finite;
  for (int n = 0; n < static_cast<int>(discs_.size()); ++n) {
    const Disc& disc = discs_[n];
    if (!std::isfinite(disc.x) || !std::isfinite(disc.y) ||
        !std::isfinite(disc.radius)) {
      continue;
    }
    finite.push_back(n);
    largest = std::max(largest, disc.radius);
  }
  std::vector<std::vector<int>> by_octave(kOctaves);
  for (const int n : finite) {
    const double octave = std::log2(largest / discs_[n].radius);
    by_octave[static_cast<int>(std::clamp(octave, 0.0, kOctaves - 1.0))]
        .push_back(n);
  }
  for (std::vector<int>& of_octave : by_octave) {
    if (!of_octave.empty()) {
      grids_.push_back(MakeGrid(discs_, std::move(of_octave)));
    }
  }
}

DiscIndex::Grid DiscIndex::MakeGrid(const std::vector<Disc>& all,
                                    std::vector<int> discs) {
  Grid grid;
  const Disc& any = all[discs.front()];
  double high_x = any.x, high_y = any.y;
  grid.low_x = any.x;
  grid.low_y = any.y;
  for (const int n : discs) {
    grid.low_x = std::min(grid.low_x, all[n].x);
    grid.low_y = std::min(grid.low_y, all[n].y);
    high_x = std::max(high_x, all[n].x);
    high_y = std::max(high_y, all[n].y);
    grid.largest_radius = std::max(grid.largest_radius, all[n].radius);
  }
  // Square cells, no more along a side than there are discs.
  const double width = high_x - grid.low_x, height = high_y - grid.low_y;
  const double count = static_cast<double>(discs.size());
  const double cell = std::max(std::sqrt(width * height / count),
                               std::max(width, height) / count);
  if (cell > 0) grid.cell = cell;
  grid.columns = grid.ColumnOf(high_x) + 1;
  grid.rows = grid.RowOf(high_y) + 1;
  const auto cell_of = [&](int n) {
    return grid.RowOf(all[n].y) * grid.columns + grid.ColumnOf(all[n].x);
  };
  std::stable_sort(discs.begin(), discs.end(),
                   [&](int a, int b) { return cell_of(a) < cell_of(b); });
  grid.first.assign(static_cast<std::size_t>(grid.columns) * grid.rows + 1, 0);
  for (const int n : discs) ++grid.first[cell_of(n) + 1];
  for (std::size_t c = 1; c < grid.first.size(); ++c) {
    grid.first[c] += grid.first[c - 1];
  }
  grid.discs = std::move(discs);
  return grid;
}

void DiscIndex::Start(const Disc& query) {
  query_ = query;
  heap_.clear();
  for (int g = 0; g < static_cast<int>(grids_.size()); ++g) {
    // The ring that first meets the grid.
    const Grid& grid = grids_[g];
    const int column = grid.ColumnOf(query.x), row = grid.RowOf(query.y);
    PushRing(g, std::max({0, -column, column - grid.columns + 1, -row,
                          row - grid.rows + 1}));
  }
}

void DiscIndex::Push(const Entry& entry) {
  heap_.push_back(entry);
  std::push_heap(heap_.begin(), heap_.end());
}

void DiscIndex::PushRing(int g, int ring) {
  const Grid& grid = grids_[g];
  const int column = grid.ColumnOf(query_.x), row = grid.RowOf(query_.y);
  if (ring >
      std::max({column, grid.columns - 1 - column, row, grid.rows - 1 - row})) {
    return;  // beyond the grid
  }
  const double distance =
      std::max(0.0, (ring - 1 - kDistanceRounding) * grid.cell);
  Push({{distance - grid.largest_radius - query_.radius -
             kDistanceRounding * grid.cell,
         kRing},
        g,
        ring});
}

const std::pair<double, int>* DiscIndex::Front() {
  while (!heap_.empty() && heap_.front().gap.second == kRing) {
    const Entry entry = heap_.front();
    Pop();
    LookAt(grids_[entry.grid], entry.ring);
    PushRing(entry.grid, entry.ring + 1);
  }
  return heap_.empty() ? nullptr : &heap_.front().gap;
}

void DiscIndex::Pop() {
  std::pop_heap(heap_.begin(), heap_.end());
  heap_.pop_back();
}

void DiscIndex::LookAt(const Grid& grid, int ring) {
  const int column = grid.ColumnOf(query_.x), row = grid.RowOf(query_.y);
  for (int r = std::max(row - ring, 0);
       r <= std::min(row + ring, grid.rows - 1); ++r) {
    if (ring == 0 || std::abs(r - row) == ring) {
      LookAtCells(grid, r, column - ring, column + ring);
    } else {
      LookAtCells(grid, r, column - ring, column - ring);
      LookAtCells(grid, r, column + ring, column + ring);
    }
  }
}

void DiscIndex::LookAtCells(const Grid& grid, int row, int first_column,
                            int last_column) {
  first_column = std::max(first_column, 0);
  last_column = std::min(last_column, grid.columns - 1);
  if (first_column > last_column) return;
  const int end = grid.first[row * grid.columns + last_column + 1];
  for (int d = grid.first[row * grid.columns + first_column]; d < end; ++d) {
    const Disc& disc = discs_[grid.discs[d]];
    const double dx = disc.x - query_.x, dy = disc.y - query_.y;
    const double gap =
        std::sqrt(dx * dx + dy * dy) - disc.radius - query_.radius;
    Push({{gap, grid.discs[d]}, 0, 0});
  }
}

}  // namespace lowlap
