#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "lowlap/core/ids.h"
#include "lowlap/io/internal/failure.h"

namespace lowlap {

// Two archives with the same operations, so that one function describes the
// bytes of a record for writing (from const data) and for reading. Everything
// is little-endian and unpadded.

class ByteWriter {
 public:
  static constexpr bool kReads = false;

  explicit ByteWriter(std::string& bytes) : bytes_(bytes) {}

  template <class Unsigned>
  void Integer(Unsigned value) {
    static_assert(std::is_unsigned_v<Unsigned>);
    char encoded[sizeof(Unsigned)];
    for (std::size_t n = 0; n < sizeof(Unsigned); ++n) {
      encoded[n] = static_cast<char>(value >> (8 * n));
    }
    bytes_.append(encoded, sizeof(Unsigned));
  }
  template <class Thing>
  void Integer(Id<Thing> id) {
    Integer(id.value());
  }
  void Count(int value) { Integer(static_cast<std::uint32_t>(value)); }
  void Real(double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    Integer(bits);
  }
  void Reals(const double* values, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) Real(values[n]);
  }
  void Text(const std::string& text) {
    Length(text.size(), 1);
    bytes_ += text;
  }
  std::size_t Length(std::size_t size, std::size_t) {
    Integer(static_cast<std::uint64_t>(size));
    return size;
  }

 private:
  std::string& bytes_;
};

class ByteReader {
 public:
  static constexpr bool kReads = true;

  /// `place` names the bytes in errors; `offset` is that of their beginning.
  ByteReader(std::string_view bytes, std::string place, std::size_t offset)
      : bytes_(bytes), place_(std::move(place)), end_(offset + bytes.size()) {}

  [[noreturn]] void Fail(std::string message,
                         ErrorCode code = ErrorCode::kParse) const {
    throw Failure{
        Error{code,
              std::move(message),
              {},
              place_ + "byte " + std::to_string(end_ - bytes_.size())}};
  }
  std::size_t BytesLeft() const { return bytes_.size(); }

  template <class Unsigned>
  void Integer(Unsigned& value) {
    static_assert(std::is_unsigned_v<Unsigned>);
    value = Decoded<Unsigned>(Take(sizeof(Unsigned)).data());
  }
  template <class Thing>
  void Integer(Id<Thing>& id) {
    std::uint32_t value = 0;
    Integer(value);
    id = value;
  }
  void Count(int& value) {
    std::uint32_t stored = 0;
    Integer(stored);
    if (stored > static_cast<std::uint32_t>(std::numeric_limits<int>::max())) {
      Fail("a count is out of range");
    }
    value = static_cast<int>(stored);
  }
  void Real(double& value) { Reals(&value, 1); }
  void Reals(double* values, std::size_t count) {
    const char* encoded = Take(count * sizeof(double)).data();
    for (std::size_t n = 0; n < count; ++n) {
      const auto bits =
          Decoded<std::uint64_t>(encoded + n * sizeof(std::uint64_t));
      std::memcpy(values + n, &bits, sizeof bits);
    }
  }
  void Text(std::string& text) { text = Take(Length(0, 1)); }
  /// The number of items that follow, each of at least `min_bytes`; no larger
  /// than the bytes that are left allow.
  std::size_t Length(std::size_t, std::size_t min_bytes) {
    std::uint64_t size = 0;
    Integer(size);
    if (size > bytes_.size() / min_bytes) {
      Fail("a length of " + std::to_string(size) +
           " exceeds the bytes that are left");
    }
    return static_cast<std::size_t>(size);
  }
  std::string_view Take(std::size_t count) {
    if (count > bytes_.size()) Fail("the data ends early");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

 private:
  template <class Unsigned>
  static Unsigned Decoded(const char* encoded) {
    Unsigned decoded = 0;
    for (std::size_t n = 0; n < sizeof(Unsigned); ++n) {
      const auto byte = static_cast<unsigned char>(encoded[n]);
      decoded = static_cast<Unsigned>(decoded | static_cast<Unsigned>(byte)
                                                    << (8 * n));
    }
    return decoded;
  }

  std::string_view bytes_;
  std::string place_;
  std::size_t end_;
};

}  // namespace lowlap
