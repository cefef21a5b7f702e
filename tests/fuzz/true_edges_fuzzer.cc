// The true edges of a rendered room.
#include "fuzz_input.h"
#include "lowlap/evaluation/internal/line_truth.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const fuzz::InputFolder folder(fuzz::Bytes(data, size));
  fuzz::CheckResult(ReadTrueEdges(folder.File()), folder.File());
  return 0;
}
