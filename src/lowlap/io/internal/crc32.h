#pragma once

#include <cstdint>
#include <string_view>

namespace lowlap::internal {

/// CRC-32 (ISO-HDLC: polynomial 0x04C11DB7 reflected, as in zlib and PNG).
std::uint32_t Crc32(std::string_view bytes);

}  // namespace lowlap::internal
