#include "lowlap/synthetic/internal/simulate_ratios.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr std::uint64_t kRatioStream = 9'000'000'000;

std::uint64_t RatioStream(const ViewTriplet& views) {
  return kRatioStream + views.first.value() * 1'000'000'000'039ull +
         views.middle.value() * 1'000'003ull + views.last.value();
}

// Of the relative poses whose rotation is not the true one.
std::set<ViewPair> WrongPoses(const SyntheticScene& synthetic) {
  std::set<ViewPair> wrong;
  for (const auto& [pair, edge] : synthetic.scene.relative_poses) {
    const Mat3 truth = synthetic.true_poses.at(pair.second).rotation *
                       synthetic.true_poses.at(pair.first).rotation.transpose();
    if (RotationAngleBetween(edge.rotation, truth) > RadFromDeg(10)) {
      wrong.insert(pair);
    }
  }
  return wrong;
}

ViewPair PairOf(ViewId a, ViewId b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

Status SimulatedRatioOptions::Validate() const {
  const auto invalid = [](const char* message) {
    return MakeError(ErrorCode::kInvalidArgument, message);
  };
  if (!IsPositive(log_stddev)) {
    return invalid("log_stddev must be finite and positive");
  }
  if (!(wrong_share >= 0 && wrong_share <= 1)) {
    return invalid("wrong_share must be in [0, 1]");
  }
  if (!(min_factor > 1) || !(max_factor >= min_factor) ||
      !std::isfinite(max_factor)) {
    return invalid("min_factor must be above 1 and at most max_factor");
  }
  return {};
}

Status SimulateRatios(const SimulatedRatioOptions& options,
                      SyntheticScene* synthetic) {
  if (const Status valid = options.Validate(); !valid) return valid;
  std::set<ViewPair> wrong_poses;
  if (options.wrong_beside_wrong_poses) wrong_poses = WrongPoses(*synthetic);
  std::vector<std::pair<std::uint64_t, ScaleRatio>> drawn;
  for (const ViewTriplet& views : FindTriplets(ViewGraph(synthetic->scene))) {
    const std::optional<double> truth = synthetic->TrueLogRatio(views);
    if (!truth) continue;
    Random random(options.seed, RatioStream(views));
    const std::uint64_t rank = random.NextBits();
    ScaleRatio ratio;
    ratio.views = views;
    ratio.verdict = RatioVerdict::kMeaningful;
    ratio.log_ratio_stddev = options.log_stddev;
    ratio.log_ratio = *truth + random.Gaussian(options.log_stddev);
    ratio.log10_nfa = random.Uniform(-30, -5);
    const bool is_wrong =
        random.Uniform() < options.wrong_share ||
        wrong_poses.count(PairOf(views.first, views.middle)) > 0 ||
        wrong_poses.count(PairOf(views.middle, views.last)) > 0;
    const double size = random.Uniform(std::log(options.min_factor),
                                       std::log(options.max_factor));
    const double sign = random.Uniform() < 0.5 ? -1 : 1;
    if (is_wrong) ratio.log_ratio += sign * size;
    drawn.emplace_back(rank, std::move(ratio));
  }
  if (options.max_ratios > 0 && drawn.size() > options.max_ratios) {
    std::stable_sort(
        drawn.begin(), drawn.end(),
        [](const auto& a, const auto& b) { return a.first < b.first; });
    drawn.resize(options.max_ratios);
    std::sort(drawn.begin(), drawn.end(), [](const auto& a, const auto& b) {
      return a.second.views < b.second.views;
    });
  }
  synthetic->scene.scale_ratios.clear();
  for (auto& entry : drawn) {
    synthetic->scene.scale_ratios.push_back(std::move(entry.second));
  }
  return {};
}

}  // namespace lowlap
