#include "lowlap/averaging/strategies.h"

#include <utility>

#include "lowlap/averaging/strategies/internal/bata.h"
#include "lowlap/averaging/strategies/internal/global_positioning.h"
#include "lowlap/averaging/strategies/internal/graph_scales.h"
#include "lowlap/averaging/strategies/internal/l2_chordal.h"
#include "lowlap/averaging/strategies/internal/lud.h"
#include "lowlap/averaging/strategies/internal/one_dsfm.h"
#include "lowlap/averaging/strategies/internal/revised_bata.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"
#include "lowlap/averaging/strategies/internal/scale_chain.h"
#include "lowlap/averaging/strategies/internal/soft_l1.h"
#include "lowlap/averaging/strategies/internal/triplet_programs.h"

namespace lowlap {
namespace {

using Factory = std::unique_ptr<TranslationAverager> (*)();

template <typename Averager>
std::unique_ptr<TranslationAverager> Make() {
  return std::make_unique<Averager>();
}

template <TripletProgramAverager::Norm kNorm>
std::unique_ptr<TranslationAverager> MakeProgram() {
  return std::make_unique<TripletProgramAverager>(kNorm);
}

template <std::size_t kMinViewsPerTrack>
std::unique_ptr<TranslationAverager> MakePositioning() {
  GlobalPositioningOptions options;
  options.min_views_per_track = kMinViewsPerTrack;
  return std::make_unique<GlobalPositioningAverager>(std::move(options));
}

struct Strategy {
  const char* name;
  Factory make;
};

// The default first.
constexpr Strategy kStrategies[] = {
    {"graph", Make<GraphScalesAverager>},
    {"chain", Make<ScaleChainAverager>},
    {"linf", MakeProgram<TripletProgramAverager::Norm::kMaximum>},
    {"l1_lp", MakeProgram<TripletProgramAverager::Norm::kSum>},
    {"global_positioning", MakePositioning<3>},
    {"global_positioning_2view", MakePositioning<2>},
    {"l2_chordal", Make<L2ChordalAverager>},
    {"soft_l1", Make<SoftL1Averager>},
    {"lud", Make<LudAverager>},
    {"revised_lud", Make<RevisedLudAverager>},
    {"bata", Make<BataAverager>},
    {"revised_bata", Make<RevisedBataAverager>},
};

}  // namespace

std::vector<std::string> TranslationAveragerNames() {
  std::vector<std::string> names;
  for (const Strategy& strategy : kStrategies) names.push_back(strategy.name);
  return names;
}

Result<std::unique_ptr<TranslationAverager>> MakeTranslationAverager(
    const std::string& name) {
  const std::string filter = "1dsfm+";
  if (name.rfind(filter, 0) == 0) {
    auto inner = MakeTranslationAverager(name.substr(filter.size()));
    if (!inner) return inner;
    return std::make_unique<OneDSfmAverager>(std::move(*inner));
  }
  std::string known;
  for (const Strategy& strategy : kStrategies) {
    if (name == strategy.name) return strategy.make();
    known += (known.empty() ? "" : ", ") + std::string(strategy.name);
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "unknown strategy '" + name + "'; known: " + known +
                       "; each also behind the filter " + filter);
}

}  // namespace lowlap
