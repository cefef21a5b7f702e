#pragma once

#include "lowlap/geometry/types.h"
#include "lowlap/io/internal/byte_archive.h"

namespace lowlap {

// The bytes of matrices, optional values and containers. Each function serves
// ByteWriter (with const data) and ByteReader.

template <class Archive, class Matrix>
void TransferMatrix(Archive& archive, Matrix& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) {
      archive.Real(matrix(row, col));
    }
  }
}

/// A byte 0 or 1, then the value if 1.
template <class Archive, class Optional, class Transfer>
void TransferOptional(Archive& archive, Optional& value,
                      const Transfer& transfer) {
  if constexpr (Archive::kReads) {
    std::uint8_t present = 0;
    archive.Integer(present);
    if (present > 1) archive.Fail("a flag is neither 0 nor 1");
    if (present) transfer(archive, value.emplace());
  } else {
    archive.Integer(static_cast<std::uint8_t>(value.has_value()));
    if (value) transfer(archive, *value);
  }
}

/// An enumeration with the values 0 ... last, as one byte.
template <class Archive, class Value, class Enum>
void TransferEnum(Archive& archive, Value& value, Enum last) {
  if constexpr (Archive::kReads) {
    std::uint8_t stored = 0;
    archive.Integer(stored);
    if (stored > static_cast<std::uint8_t>(last)) {
      archive.Fail("a kind is not known");
    }
    value = static_cast<Enum>(stored);
  } else {
    archive.Integer(static_cast<std::uint8_t>(value));
  }
}

/// The number of items, then each; `min_bytes` is the least size of an item.
template <class Archive, class Vector, class Transfer>
void TransferVector(Archive& archive, Vector& items, std::size_t min_bytes,
                    const Transfer& transfer) {
  const std::size_t size = archive.Length(items.size(), min_bytes);
  if constexpr (Archive::kReads) items.resize(size);
  for (auto& item : items) transfer(archive, item);
}

/// The number of entries, then each: u32 key, value. Keys ascend.
template <class Archive, class Map, class Transfer>
void TransferMap(Archive& archive, Map& map, const Transfer& transfer) {
  std::size_t size = archive.Length(map.size(), sizeof(std::uint32_t));
  if constexpr (Archive::kReads) {
    for (; size > 0; --size) {
      std::uint32_t key = 0;
      archive.Integer(key);
      if (!map.empty() && key <= map.rbegin()->first) {
        archive.Fail("ids must ascend");
      }
      transfer(archive,
               map.emplace_hint(map.end(), key, typename Map::mapped_type{})
                   ->second);
    }
  } else {
    for (auto& [key, value] : map) {
      archive.Integer(key);
      transfer(archive, value);
    }
  }
}

}  // namespace lowlap
