#include "lowlap/matching/internal/loops/place_transfer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "lowlap/core/internal/median.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxNeighbours = 3;

}  // namespace

PlaceTransfer::PlaceTransfer(const std::vector<Match>& matches,
                             double radius_px)
    : radius_px_(radius_px) {
  entries_.reserve(matches.size());
  for (const Match& match : matches) {
    if (!match.from_px.allFinite() || !match.to_px.allFinite()) continue;
    entries_.push_back({CellOf(match.from_px), match});
  }
  std::stable_sort(
      entries_.begin(), entries_.end(),
      [](const Entry& a, const Entry& b) { return a.cell < b.cell; });
}

PlaceTransfer::Cell PlaceTransfer::CellOf(const Vec2& place_px) const {
  return {static_cast<std::int64_t>(std::floor(place_px.y() / radius_px_)),
          static_cast<std::int64_t>(std::floor(place_px.x() / radius_px_))};
}

std::optional<Vec2> PlaceTransfer::Apply(const Vec2& place_px) const {
  if (!place_px.allFinite()) return std::nullopt;
  const auto [row, column] = CellOf(place_px);
  std::vector<std::pair<double, const Match*>> near;
  for (std::int64_t r = row - 1; r <= row + 1; ++r) {
    const auto begin = std::lower_bound(
        entries_.begin(), entries_.end(), Cell{r, column - 1},
        [](const Entry& entry, const Cell& cell) { return entry.cell < cell; });
    for (auto entry = begin;
         entry != entries_.end() && entry->cell <= Cell{r, column + 1};
         ++entry) {
      const double distance_px = (entry->match.from_px - place_px).norm();
      if (distance_px >= radius_px_) continue;
      near.emplace_back(distance_px, &entry->match);
    }
  }
  if (near.empty()) return std::nullopt;
  const auto end = near.begin() + static_cast<std::ptrdiff_t>(
                                      std::min(near.size(), kMaxNeighbours));
  std::partial_sort(
      near.begin(), end, near.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<double> x, y;
  for (auto entry = near.begin(); entry != end; ++entry) {
    const Vec2 offset_px = entry->second->to_px - entry->second->from_px;
    x.push_back(offset_px.x());
    y.push_back(offset_px.y());
  }
  return place_px + Vec2(Median(std::move(x)), Median(std::move(y)));
}

}  // namespace lowlap
