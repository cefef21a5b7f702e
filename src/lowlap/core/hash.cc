#include "lowlap/core/hash.h"

namespace lowlap {

void Hash128::AddBytes(std::string_view bytes) {
  // Times the prime 2^88 + 0x13b, in two halves.
  constexpr std::uint64_t kPrimeLow = 0x13b;
  std::uint64_t high = high_, low = low_;
  for (const char byte : bytes) {
    low ^= static_cast<unsigned char>(byte);
    const std::uint64_t carry =
        ((low >> 32) * kPrimeLow + (((low & 0xffffffffu) * kPrimeLow) >> 32)) >>
        32;
    high = high * kPrimeLow + carry + (low << 24);
    low *= kPrimeLow;
  }
  high_ = high;
  low_ = low;
}

void Hash128::Add(std::string_view text) {
  Add(static_cast<std::uint64_t>(text.size()));
  AddBytes(text);
}

void Hash128::Add(const Value& value) {
  Add(value.high);
  Add(value.low);
}

std::string ToHex(const Hash128::Value& value) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint64_t half : {value.high, value.low}) {
    for (int shift = 60; shift >= 0; shift -= 4) {
      text += kDigits[half >> shift & 0xf];
    }
  }
  return text;
}

}  // namespace lowlap
