#include "lowlap/averaging/reliability/internal/bare_regions.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr double kFoundPerRegion = 3;
constexpr int kMaxDivisions = 4;

using Iterator = std::vector<ExpectedSighting>::iterator;

struct Division {
  OverlapRegions regions;
  /// Of those in regions that are not bare.
  double num_expected = 0, num_found = 0;
};

void Divide(Iterator begin, Iterator end, double size, Division* division) {
  const auto count = static_cast<double>(end - begin);
  if (count < 2 * size) {
    const auto found = std::count_if(
        begin, end, [](const ExpectedSighting& s) { return s.is_found; });
    ++division->regions.num;
    if (found == 0) {
      ++division->regions.num_bare;
    } else {
      division->num_expected += count;
      division->num_found += static_cast<double>(found);
    }
    return;
  }
  Eigen::AlignedBox2d box;
  for (auto seen = begin; seen != end; ++seen) box.extend(seen->pixel_px);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const Iterator middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end,
                   [&](const ExpectedSighting& a, const ExpectedSighting& b) {
                     return a.pixel_px[axis] < b.pixel_px[axis];
                   });
  Divide(begin, middle, size, division);
  Divide(middle, end, size, division);
}

}  // namespace

OverlapRegions DivideOverlap(std::vector<ExpectedSighting> expected,
                             double min_rate) {
  const auto num_found =
      std::count_if(expected.begin(), expected.end(),
                    [](const ExpectedSighting& seen) { return seen.is_found; });
  if (num_found < kFoundPerRegion) return {};
  Division division;
  division.num_found = static_cast<double>(num_found);
  division.num_expected = static_cast<double>(expected.size());
  for (int round = 0; round < kMaxDivisions; ++round) {
    const double rate =
        std::max(min_rate, division.num_found / division.num_expected);
    division = {};
    Divide(expected.begin(), expected.end(), kFoundPerRegion / rate, &division);
    if (division.regions.num_bare == 0) break;
  }
  return division.regions;
}

double Log10ChanceOfBare(const OverlapRegions& regions, double chance_of_bare) {
  return Log10BinomialTail(regions.num, regions.num_bare, chance_of_bare);
}

}  // namespace lowlap
