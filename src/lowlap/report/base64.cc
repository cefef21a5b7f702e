#include "lowlap/report/internal/base64.h"

#include <cstddef>
#include <cstdint>

namespace lowlap {

std::string Base64(std::string_view bytes) {
  constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      group = group << 8 |
              (at + n < bytes.size() ? static_cast<unsigned char>(bytes[at + n])
                                     : 0u);
    }
    for (std::size_t n = 0; n < 4; ++n) {
      text +=
          at + n <= bytes.size() ? kDigits[group >> (18 - 6 * n) & 63] : '=';
    }
  }
  return text;
}

}  // namespace lowlap
