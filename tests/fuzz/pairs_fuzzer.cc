// Files of pairs.
#include "fuzz_input.h"
#include "lowlap/matching/internal/pair_selection.h"

namespace {

lowlap::Scene NamedViews() {
  lowlap::Scene scene;
  for (int n = 0; n < 4; ++n) {
    scene.views[n].local_path = n < 2 ? "left" : "";
    scene.views[n].filename = "photo " + std::to_string(n % 3) + ".jpg";
  }
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  static const Scene scene = NamedViews();
  const std::string text(fuzz::Bytes(data, size));
  fuzz::CheckResult(ParsePairs(scene, text, "pairs.txt"), "pairs.txt");
  return 0;
}
