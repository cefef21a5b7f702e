// Scenes in binary, as they are, and with checksums that are right: hardly any
// change would get beyond them.
#include <zlib.h>

#include <cstring>

#include "fuzz_input.h"
#include "lowlap/io/internal/scene_binary.h"

namespace {

// Magic number, version, number of sections.
constexpr std::size_t kHeadSize = 16;
// A section: tag, checksum, length, content.
constexpr std::size_t kTagSize = 4;
constexpr std::size_t kSectionHeadSize = 16;

std::string WithChecksums(std::string bytes) {
  for (std::size_t at = kHeadSize; at + kSectionHeadSize <= bytes.size();) {
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + at + 8, sizeof length);
    const std::size_t content = at + kSectionHeadSize;
    if (length > bytes.size() - content) break;
    const auto sum = static_cast<std::uint32_t>(::crc32_z(
        0, reinterpret_cast<const Bytef*>(bytes.data() + content), length));
    std::memcpy(bytes.data() + at + kTagSize, &sum, sizeof sum);
    at = content + length;
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace lowlap;
  const std::string bytes(fuzz::Bytes(data, size));
  fuzz::CheckResult(ParseSceneBinary(bytes, "a.lowlap"), "a.lowlap");
  fuzz::CheckScene(ParseSceneBinary(WithChecksums(bytes), "a.lowlap"),
                   "a.lowlap");
  return 0;
}
