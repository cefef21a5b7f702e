#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

namespace lowlap {

/// XXH3 of 128 bits (Collet, xxHash) over everything added, in order. Tells
/// contents apart and notices damage; no defence against somebody who looks for
/// a collision.
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

  Hash128();
  ~Hash128();

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

  Value value() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// 32 hexadecimal digits.
std::string ToHex(const Hash128::Value& value);

}  // namespace lowlap
