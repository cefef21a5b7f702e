#include "lowlap/adjustment/internal/rounds/pair_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lowlap/adjustment/internal/costs/coplanar_costs.h"
#include "lowlap/adjustment/internal/costs/line_reprojection_cost.h"
#include "lowlap/adjustment/internal/rounds/problem_selection.h"

namespace lowlap {
namespace {

LineParameters Parameters(const LineTrackState& line) {
  LineParameters parameters;
  parameters << line.point, line.direction;
  return parameters;
}

}  // namespace

std::vector<PairTerm> PairTerms(const StructureState& state,
                                const PairState& pair,
                                AdjustedCoplanarResidual residual) {
  const std::vector<int> first = ViewsOf(state.lines[pair.first]);
  const std::vector<int> second = ViewsOf(state.lines[pair.second]);
  std::vector<PairTerm> terms;
  if (residual == AdjustedCoplanarResidual::kImageDistance) {
    for (const int view : first) {
      if (std::binary_search(second.begin(), second.end(), view)) {
        terms.push_back({view, pair.first, pair.second});
      }
    }
    return terms;
  }
  for (const int view : second) {
    terms.push_back({view, pair.first, pair.second});
  }
  for (const int view : first) {
    terms.push_back({view, pair.second, pair.first});
  }
  return terms;
}

double PairErrorPx(const CameraSet& cameras, const StructureState& state,
                   const PairState& pair, AdjustedCoplanarResidual residual) {
  const std::vector<PairTerm> terms = PairTerms(state, pair, residual);
  if (terms.empty()) return kInfinity;
  double squares = 0;
  for (const PairTerm& term : terms) {
    const LineParameters on = Parameters(state.lines[term.on]);
    const LineParameters to = Parameters(state.lines[term.to]);
    const double focal_px = cameras.IntrinsicOf(term.view).value.MeanFocalPx();
    const Vec3& center = cameras.PoseOf(term.view).center;
    const double* const blocks[] = {center.data(), on.data(), to.data()};
    double values[3] = {0, 0, 0};
    if (residual == AdjustedCoplanarResidual::kTransfer) {
      CoplanarTransferCost(focal_px).Evaluate(blocks, values, nullptr);
    } else {
      CoplanarImageDistanceCost(focal_px).Evaluate(blocks, values, nullptr);
    }
    squares +=
        values[0] * values[0] + values[1] * values[1] + values[2] * values[2];
  }
  const double error = std::sqrt(squares / static_cast<double>(terms.size()));
  return std::isfinite(error) ? error : kInfinity;
}

}  // namespace lowlap
