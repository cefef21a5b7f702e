#include "lowlap/io/internal/crc32.h"

#include <array>

namespace lowlap::internal {
namespace {

constexpr int kSlices = 8;
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

// tables[s][b]: the remainder of byte b followed by s zero bytes.
constexpr Tables MakeTables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) {
      remainder = (remainder >> 1) ^ ((remainder & 1) ? 0xEDB88320u : 0u);
    }
    tables[0][byte] = remainder;
  }
  for (int slice = 1; slice < kSlices; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t previous = tables[slice - 1][byte];
      tables[slice][byte] = (previous >> 8) ^ tables[0][previous & 0xFF];
    }
  }
  return tables;
}

constexpr Tables kTables = MakeTables();

}  // namespace

std::uint32_t Crc32(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  const auto byte = [&](std::size_t n) {
    return static_cast<unsigned char>(bytes[n]);
  };
  // Eight bytes at a time: their remainders are independent look-ups.
  while (bytes.size() >= kSlices) {
    std::uint32_t next = 0;
    for (std::size_t n = 0; n < kSlices; ++n) {
      const std::uint32_t mixed =
          n < 4 ? byte(n) ^ ((crc >> (8 * n)) & 0xFF) : byte(n);
      next ^= kTables[kSlices - 1 - n][mixed];
    }
    crc = next;
    bytes.remove_prefix(kSlices);
  }
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    crc = (crc >> 8) ^ kTables[0][(crc ^ byte(n)) & 0xFF];
  }
  return ~crc;
}

}  // namespace lowlap::internal
