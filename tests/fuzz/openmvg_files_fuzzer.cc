// OpenMVG's features and matches, each by itself.
#include "fuzz_input.h"
#include "third_party_adapters/openmvg/internal/feat.h"
#include "third_party_adapters/openmvg/internal/matches.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const std::string_view bytes = fuzz::Bytes(data, size);
  fuzz::CheckResult(openmvg::ParseFeat(bytes, "a.feat"), "a.feat");
  fuzz::CheckResult(openmvg::ParseMatchesText(bytes, "m.txt"), "m.txt");
  fuzz::CheckResult(openmvg::ParseMatchesBin(bytes, "m.bin"), "m.bin");
  return 0;
}
