// What stands on the command line in words of our own: strategies, refined
// parts, pairs.
#include "fuzz_input.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/averaging/averager_registry.h"
#include "lowlap/matching/internal/pair_selection.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/synthetic/internal/pair_graph.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const std::string text(fuzz::Bytes(data, size));
  static const auto registry = AveragerRegistry::WithBuiltIns();
  for (const std::string& request : SplitRequests(text)) {
    fuzz::CheckResult(registry.Make(request), "");
  }
  fuzz::CheckResult(ParseRefinement(text), "");
  fuzz::CheckResult(ParseCoplanarTies(text), "");
  fuzz::CheckResult(PairRule::Parse(text), "");
  Scene scene;
  for (int n = 0; n < 3; ++n) scene.views[n].filename = std::to_string(n);
  fuzz::CheckResult(FindViews(scene, {text}), "");
  // A path with a null character would be cut there.
  if (text.find('\0') == std::string::npos) {
    fuzz::CheckResult(SelectViewPairs(scene, text), "");
  }
  return 0;
}
