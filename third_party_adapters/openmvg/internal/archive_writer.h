#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

namespace lowlap::openmvg::internal {

/// Writes a little-endian cereal PortableBinary archive into memory.
class ArchiveWriter {
 public:
  ArchiveWriter() { Scalar<std::uint8_t>(1); }

  template <class T>
  void Scalar(T value) {
    char buffer[sizeof(T)];
    std::memcpy(buffer, &value, sizeof(T));
    const std::uint16_t one = 1;
    char low_byte_first;
    std::memcpy(&low_byte_first, &one, 1);
    for (std::size_t n = 0; n < sizeof(T); ++n) {
      bytes_.push_back(buffer[low_byte_first ? n : sizeof(T) - 1 - n]);
    }
  }
  void U32(std::uint32_t value) { Scalar(value); }
  void Count(std::size_t count) { Scalar(static_cast<std::uint64_t>(count)); }
  void String(const std::string& value) {
    Count(value.size());
    bytes_ += value;
  }
  void Doubles(const double* values, std::size_t length) {
    Count(length);
    for (std::size_t n = 0; n < length; ++n) Scalar(values[n]);
  }

  std::string TakeBytes() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace lowlap::openmvg::internal
