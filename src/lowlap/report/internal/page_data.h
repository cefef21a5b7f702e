#pragma once

#include <cstddef>
#include <string>

#include "lowlap/report/internal/report.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What the page holds at most, so that it stays small and quick.
struct PageLimits {
  std::size_t points = 100000;          // in space
  std::size_t features = 600000;        // points with a match, of all views
  std::size_t detected = 120000;        // points and segments without a match
  std::size_t pairs = 5000;             // those in use, then of most evidence
  std::size_t triplets = 4000;          // those with a profile, then likewise
  std::size_t profiles_by_kind = 1000;  // beyond, profiles are totals only
};

/// The data of the page as one JSON object that may stand in a <script>
/// element: no "<" is left in it. Numbers that there are many of are typed
/// arrays in Base64. Members:
///   title, figures, warnings, notes: texts
///   views: name, size, photograph, features, cameras; by ascending id
///   points, lines, coplanar_pairs: structure, in the frame of
///     ChooseDisplayFrame
///   pairs, triplets: the view graph and its ratios; views by their place
///   residuals: histograms, before and after the adjustment
///   thinning: every how many-th point is shown, and the like
std::string PageData(const Scene& scene, const ReportContent& content,
                     const PageLimits& limits = {});

}  // namespace lowlap
