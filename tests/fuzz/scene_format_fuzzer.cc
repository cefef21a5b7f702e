// ReadScene of one format; of the format that the content tells, if
// LOWLAP_FUZZED_FORMAT is empty.
#include <filesystem>

#include "fuzz_input.h"
#include "third_party_adapters/scene_formats.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const fuzz::InputFolder folder(fuzz::Bytes(data, size));
  // A format that keeps its scenes in folders has none called `input`.
  const std::string file = folder.File();
  const std::string path = std::filesystem::exists(file) ? file : folder.path();
  SceneNotes notes;
  fuzz::CheckScene(ReadScene(path, &notes, LOWLAP_FUZZED_FORMAT),
                   folder.path());
  return 0;
}
