// A listing of OpenMVG with its features and matches.
#include "fuzz_input.h"
#include "third_party_adapters/openmvg/internal/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const fuzz::InputFolder folder(fuzz::Bytes(data, size));
  const auto project = openmvg::ImportProject(folder.File(), folder.path());
  fuzz::CheckResult(project, folder.path());
  return 0;
}
