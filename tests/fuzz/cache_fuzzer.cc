// Entries of the cache, and what they hold.
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "fuzz_input.h"
#include "lowlap/pipeline/internal/measure/cache/cache_folder.h"
#include "lowlap/pipeline/internal/measure/cache/measurement_bytes.h"

namespace {

void Check(bool is_same) {
  if (!is_same) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const std::string_view bytes = fuzz::Bytes(data, size);
  const auto features = FeaturesFromBytes(bytes);
  if (features) Check(ToBytes(*features) == bytes);
  const auto tilted = TiltedPointsFromBytes(bytes);
  if (tilted) Check(ToBytes(*tilted) == bytes);
  const auto matches = MatchesFromBytes(bytes);
  if (matches) Check(ToBytes(*matches) == bytes);
  const fuzz::InputFolder folder(bytes);
  const auto cache = CacheFolder::Open(folder.path());
  fuzz::CheckResult(cache, folder.path());
  const Hash128::Value key{};
  std::error_code ignored;  // an input may be without that file
  std::filesystem::rename(
      folder.File(), folder.File("matches-" + ToHex(key) + ".entry"), ignored);
  fuzz::CheckResult(cache->Read("matches", key), folder.path());
  return 0;
}
