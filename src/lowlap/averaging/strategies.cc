#include "lowlap/averaging/strategies.h"

#include "lowlap/averaging/graph_scales.h"
#include "lowlap/averaging/scale_chain.h"

namespace lowlap {
namespace {

using Factory = std::unique_ptr<TranslationAverager> (*)();

template <typename Averager>
std::unique_ptr<TranslationAverager> Make() {
  return std::make_unique<Averager>();
}

struct Strategy {
  const char* name;
  Factory make;
};

// The default first.
constexpr Strategy kStrategies[] = {
    {"graph", Make<GraphScalesAverager>},
    {"chain", Make<ScaleChainAverager>},
};

}  // namespace

std::vector<std::string> TranslationAveragerNames() {
  std::vector<std::string> names;
  for (const Strategy& strategy : kStrategies) names.push_back(strategy.name);
  return names;
}

Result<std::unique_ptr<TranslationAverager>> MakeTranslationAverager(
    const std::string& name) {
  std::string known;
  for (const Strategy& strategy : kStrategies) {
    if (name == strategy.name) return strategy.make();
    known += (known.empty() ? "" : ", ") + std::string(strategy.name);
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "unknown strategy '" + name + "'; known: " + known);
}

}  // namespace lowlap
