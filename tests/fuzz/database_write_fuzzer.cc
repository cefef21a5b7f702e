// Relative poses written into a database of COLMAP, which is read before.
#include "fuzz_input.h"
#include "third_party_adapters/colmap/internal/database.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const fuzz::InputFolder folder(fuzz::Bytes(data, size));
  SceneNotes notes;
  const auto scene = colmap::ReadDatabaseScene(folder.File(), &notes);
  if (!scene) return 0;
  fuzz::CheckResult(colmap::WriteRelativePoses(*scene, folder.File()),
                    folder.File());
  return 0;
}
