#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "lowlap/core/result.h"
#include "lowlap/io/internal/failure.h"

namespace lowlap::openmvg {

/// Reads a cereal PortableBinary archive from memory. What is wrong is thrown
/// as a Failure.
class ArchiveReader {
 public:
  /// Consumes the endianness byte.
  ArchiveReader(std::string_view bytes, std::string file)
      : bytes_(bytes), file_(std::move(file)) {
    const std::uint8_t flag = Scalar<std::uint8_t>();
    if (flag > 1) {
      offset_ = 0;
      Fail("the first byte of a binary archive is 0 or 1, this one is " +
           std::to_string(flag));
    }
    swap_ = flag != (HostIsLittleEndian() ? 1 : 0);
  }

  std::size_t offset() const { return offset_; }

  [[noreturn]] void Fail(std::string message,
                         ErrorCode code = ErrorCode::kParse) const {
    FailAt(offset_, std::move(message), code);
  }
  [[noreturn]] void FailAt(std::size_t offset, std::string message,
                           ErrorCode code = ErrorCode::kParse) const {
    throw Failure{Error{code, std::move(message), file_,
                        "byte " + std::to_string(offset)}};
  }

  template <class T>
  T Scalar() {
    if (bytes_.size() - offset_ < sizeof(T)) Fail("the file ends too early");
    T value;
    char buffer[sizeof(T)];
    for (std::size_t n = 0; n < sizeof(T); ++n) {
      buffer[swap_ ? sizeof(T) - 1 - n : n] = bytes_[offset_ + n];
    }
    std::memcpy(&value, buffer, sizeof(T));
    offset_ += sizeof(T);
    return value;
  }

  std::uint32_t U32() { return Scalar<std::uint32_t>(); }

  /// A number of items of at least `min_item_bytes` each; fails on a number
  /// that the rest of the file cannot hold.
  std::size_t Count(std::size_t min_item_bytes) {
    const std::size_t place = offset_;
    const std::uint64_t count = Scalar<std::uint64_t>();
    if (count > (bytes_.size() - offset_) / min_item_bytes) {
      FailAt(place, "a count of " + std::to_string(count) +
                        " does not fit into the rest of the file");
    }
    return static_cast<std::size_t>(count);
  }

  std::string String() {
    const std::size_t length = Count(1);
    std::string value(bytes_.substr(offset_, length));
    offset_ += length;
    return value;
  }

  /// A vector of exactly `length` finite doubles.
  void Doubles(double* values, std::size_t length);

 private:
  static bool HostIsLittleEndian() {
    const std::uint16_t one = 1;
    char first;
    std::memcpy(&first, &one, 1);
    return first == 1;
  }

  std::string_view bytes_;
  std::string file_;
  std::size_t offset_ = 0;
  bool swap_ = false;
};

}  // namespace lowlap::openmvg
