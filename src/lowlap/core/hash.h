#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace lowlap {

/// FNV-1a of 128 bits (Fowler, Noll, Vo; RFC 9923) over everything added, in
/// order. Tells contents apart and notices damage; no defence against somebody
/// who looks for a collision.
class Hash128 {
 public:
  struct Value {
    std::uint64_t high = 0;
    std::uint64_t low = 0;

    friend bool operator==(const Value& a, const Value& b) {
      return a.high == b.high && a.low == b.low;
    }
    friend bool operator!=(const Value& a, const Value& b) { return !(a == b); }
  };

  void AddBytes(std::string_view bytes);
  /// Length and bytes, so that the parts of a list cannot run together.
  void Add(std::string_view text);
  void Add(const char* text) { Add(std::string_view(text)); }
  void Add(const Value& value);
  /// Numbers as their bits.
  template <class Number>
  std::enable_if_t<std::is_arithmetic_v<Number> || std::is_enum_v<Number>> Add(
      Number number) {
    char bits[sizeof number];
    std::memcpy(bits, &number, sizeof number);
    AddBytes({bits, sizeof number});
  }

  Value value() const { return {high_, low_}; }

 private:
  std::uint64_t high_ = 0x6c62272e07bb0142ull;
  std::uint64_t low_ = 0x62b821756295c58dull;
};

/// 32 hexadecimal digits.
std::string ToHex(const Hash128::Value& value);

}  // namespace lowlap
