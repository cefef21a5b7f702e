#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// What a strategy has placed part by part, each part in a gauge of its own,
/// and the solution that the parts make. Parts may share views.
class PlacedParts {
 public:
  explicit PlacedParts(std::size_t num_views) : is_placed_(num_views, false) {}

  /// Whether any part has the view, or each of the views.
  bool Has(std::size_t view) const { return is_placed_[view]; }
  bool HasAll(const std::vector<std::size_t>& views) const {
    return std::all_of(views.begin(), views.end(),
                       [&](std::size_t view) { return Has(view); });
  }

  /// `centers`: one per view.
  void Add(std::vector<std::size_t> views, std::vector<Vec3> centers) {
    for (const std::size_t view : views) is_placed_[view] = true;
    parts_.push_back({std::move(views), std::move(centers)});
  }

  /// A component for every part, most views first (ties: as they were added).
  /// A view of several parts goes to the first of them, and a part that is left
  /// without views is no component.
  TranslationSolution MakeSolution() && {
    std::stable_sort(parts_.begin(), parts_.end(),
                     [](const Part& a, const Part& b) {
                       return a.views.size() > b.views.size();
                     });
    TranslationSolution solution;
    solution.component.assign(is_placed_.size(), -1);
    solution.center_in_world.assign(is_placed_.size(), Vec3::Zero());
    for (const Part& part : parts_) {
      bool adds_views = false;
      for (std::size_t n = 0; n < part.views.size(); ++n) {
        const std::size_t view = part.views[n];
        if (solution.component[view] >= 0) continue;
        solution.component[view] = solution.num_components;
        solution.center_in_world[view] = part.centers[n];
        adds_views = true;
      }
      if (adds_views) ++solution.num_components;
    }
    return solution;
  }

 private:
  struct Part {
    std::vector<std::size_t> views;
    std::vector<Vec3> centers;
  };
  std::vector<Part> parts_;
  std::vector<bool> is_placed_;
};

}  // namespace lowlap
