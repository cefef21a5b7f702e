#include "lowlap/averaging/strategies.h"

#include "lowlap/averaging/graph_scales.h"
#include "lowlap/averaging/scale_chain.h"

namespace lowlap {

std::vector<std::string> TranslationAveragerNames() {
  return {"graph", "chain"};
}

Result<std::unique_ptr<TranslationAverager>> MakeTranslationAverager(
    const std::string& name) {
  if (name == "graph") return std::make_unique<GraphScalesAverager>();
  if (name == "chain") return std::make_unique<ScaleChainAverager>();
  std::string known;
  for (const std::string& each : TranslationAveragerNames()) {
    known += (known.empty() ? "" : ", ") + each;
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "unknown strategy '" + name + "'; known: " + known);
}

}  // namespace lowlap
