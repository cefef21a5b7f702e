#pragma once

#include <utility>
#include <vector>

namespace lowlap {

/// A disc of the plane, such as the one around a segment.
struct Disc {
  double x = 0;
  double y = 0;
  double radius = 0;
};

/// Hands out discs by their gap to another one, the least first (ties by
/// index): the distance of the centres less both radii, which is a lower bound
/// of the distance of what the discs hold.
///
/// Exact. The discs are sorted by size (octaves of the radius) into grids of
/// about one centre a cell; rings of cells around the query are looked at in
/// the order of their own lower bounds. The first few of n discs cost O(log n)
/// where discs are spread evenly.
class DiscIndex {
 public:
  /// Numbers that are not finite are left out.
  explicit DiscIndex(std::vector<Disc> discs);

  /// Starts anew, from a disc.
  void Start(const Disc& query);
  /// Gap and index; null at the end.
  const std::pair<double, int>* Front();
  void Pop();

 private:
  // The discs of one octave of radii, by cell.
  struct Grid {
    double largest_radius = 0;
    double low_x = 0, low_y = 0;
    double cell = 1;
    int columns = 1, rows = 1;
    std::vector<int> first;  // of each cell, in `discs`; one more at the end
    std::vector<int> discs;

    int ColumnOf(double x) const;
    int RowOf(double y) const;
  };
  // A disc, or a ring of cells that has not been looked at.
  struct Entry {
    std::pair<double, int> gap;  // of a ring: a lower bound, and kRing
    int grid = 0;
    int ring = 0;

    // For a heap that hands out the least first, rings before discs.
    bool operator<(const Entry& other) const { return gap > other.gap; }
  };
  static constexpr int kRing = -1;

  static Grid MakeGrid(const std::vector<Disc>& all, std::vector<int> discs);
  void PushRing(int grid, int ring);
  void LookAt(const Grid& grid, int ring);
  void LookAtCells(const Grid& grid, int row, int first_column,
                   int last_column);
  void Push(const Entry& entry);

  std::vector<Disc> discs_;
  std::vector<Grid> grids_;
  Disc query_;
  std::vector<Entry> heap_;
};

}  // namespace lowlap
