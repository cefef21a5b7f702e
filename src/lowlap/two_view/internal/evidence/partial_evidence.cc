#include "lowlap/two_view/internal/evidence/partial_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "lowlap/two_view/internal/search/pose_from_search.h"
#include "lowlap/two_view/internal/search/pose_search.h"

namespace lowlap {
namespace {

constexpr double kApartShare = 0.02;

}  // namespace

double EvidenceOfSome(const TwoViewInput& input, const ShuffledMatches& matches,
                      const std::vector<int>& some, const RelativePose& pose,
                      const TwoViewOptions& options) {
  if (some.size() <= EssentialKernel::kSampleSize) {
    return std::numeric_limits<double>::infinity();
  }
  const PointPairs pairs = SomeOf(matches, some).pairs;
  const PoseSearch search(pairs, {}, SampsonLaw(input),
                          BoundedByPose(options, input, pose));
  return search.SupportOf(pose.Cam2FromCam1()).log10_nfa;
}

double ScatteredEvidence(const TwoViewInput& input,
                         const ShuffledMatches& matches,
                         const RelativePose& pose,
                         const TwoViewOptions& options) {
  const PointPairs& pairs = matches.pairs;
  const double apart1 =
      kApartShare * input.image_size1_px.mean() / input.features1->focal_px;
  const double apart2 =
      kApartShare * input.image_size2_px.mean() / input.features2->focal_px;
  const auto is_near = [&](int n, int other) {
    return (pairs.x1[n] - pairs.x1[other]).norm() < apart1 &&
           (pairs.x2[n] - pairs.x2[other]).norm() < apart2;
  };
  // Those of each cell of view 1; what is near lies in it or beside it.
  std::map<std::pair<double, double>, std::vector<int>> cells;
  std::vector<int> scattered;
  for (int n = 0; n < pairs.size(); ++n) {
    const double column = std::floor(pairs.x1[n].x() / apart1);
    const double row = std::floor(pairs.x1[n].y() / apart1);
    bool is_apart = true;
    for (const double x : {column - 1, column, column + 1}) {
      for (const double y : {row - 1, row, row + 1}) {
        const auto cell = cells.find({x, y});
        is_apart = is_apart &&
                   (cell == cells.end() ||
                    std::none_of(cell->second.begin(), cell->second.end(),
                                 [&](int other) { return is_near(n, other); }));
      }
    }
    if (!is_apart) continue;
    scattered.push_back(n);
    cells[{column, row}].push_back(n);
  }
  return EvidenceOfSome(input, matches, scattered, pose, options);
}

}  // namespace lowlap
