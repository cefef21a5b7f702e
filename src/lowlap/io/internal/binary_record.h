#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include "lowlap/geometry/types.h"
#include "lowlap/io/internal/byte_archive.h"
#include "lowlap/io/internal/record_traits.h"

namespace lowlap {

/// The bytes of a record, for the visitors of scene_records.h: of ByteWriter
/// (with const data) or ByteReader. Names are not stored.
template <class Bytes>
class BinaryRecord {
 public:
  static constexpr bool kReads = Bytes::kReads;
  static constexpr bool kIsText = false;
  explicit BinaryRecord(Bytes& bytes) : bytes_(bytes) {}

  template <class Value>  // enumerations are one byte, matrices their rows
  void Item(Value& value) {
    using Plain = std::remove_const_t<Value>;
    if constexpr (std::is_same_v<Plain, std::string>) {
      bytes_.Text(value);
    } else if constexpr (std::is_same_v<Plain, int>) {
      bytes_.Count(value);
    } else if constexpr (std::is_same_v<Plain, double>) {
      bytes_.Real(value);
    } else if constexpr (std::is_same_v<Plain, std::vector<double>>) {
      List({}, value, [](auto& list, auto& number) { list.Item(number); });
    } else if constexpr (std::is_same_v<Plain, ViewPair>) {
      Item(value.first);
      Item(value.second);
    } else if constexpr (std::is_same_v<Plain, ViewTriplet>) {
      Item(value.first);
      Item(value.middle);
      Item(value.last);
    } else if constexpr (std::is_enum_v<Plain>) {
      auto stored = static_cast<std::uint8_t>(value);
      bytes_.Integer(stored);
      if constexpr (kReads) {
        if (stored > static_cast<std::uint8_t>(LastOf(value))) {
          bytes_.Fail("a kind is not known");
        }
        value = static_cast<Plain>(stored);
      }
    } else if constexpr (IsEigen<Plain>::value) {
      for (Eigen::Index n = 0; n < value.size(); ++n) {
        bytes_.Real(value(n / value.cols(), n % value.cols()));
      }
    } else {
      bytes_.Integer(value);
    }
  }
  template <class Value>
  void Member(const char*, Value& value, Presence = Presence::kAlways) {
    Item(value);
  }

  /// A byte 0 or 1, then the value if 1.
  template <class Value, class Visit = VisitItem>
  void Optional(const char*, Value& value, const Visit& visit = {}) {
    auto present = static_cast<std::uint8_t>(value.has_value());
    bytes_.Integer(present);
    if constexpr (kReads) {
      if (present > 1) bytes_.Fail("a flag is neither 0 nor 1");
      if (present == 1) value.emplace();
    }
    if (value) visit(*this, *value);
  }

  /// The number of items, then each.
  template <class Vector, class Visit>
  void List(const char*, Vector& items, const Visit& visit,
            Presence = Presence::kAlways) {
    static const std::size_t min_bytes =
        LeastSize<typename Vector::value_type>(visit);
    const std::size_t size = bytes_.Length(items.size(), min_bytes);
    if constexpr (kReads) items.resize(size);
    for (auto& item : items) visit(*this, item);
  }
  template <class Vector, class Visit>
  void Flat(const char* name, Vector& items, const Visit& visit,
            Presence presence = Presence::kAlways) {
    List(name, items, visit, presence);
  }

  /// The number of entries, then each: u32 key, value. Keys ascend.
  template <class Map, class Visit>
  void MapById(Map& map, const Visit& visit) {
    std::size_t size = bytes_.Length(map.size(), sizeof(std::uint32_t));
    if constexpr (kReads) {
      for (; size > 0; --size) {
        std::uint32_t key = 0;
        Item(key);
        if (!map.empty() && key <= map.rbegin()->first) {
          bytes_.Fail("ids must ascend");
        }
        visit(*this, map.try_emplace(map.end(), key)->second);
      }
    } else {
      for (auto& [key, value] : map) {
        Item(key);
        visit(*this, value);
      }
    }
  }

  /// The number of records, then each; their pairs of views ascend.
  template <class Map, class Visit>
  void MapByViews(Map& map, const Visit& visit) {
    using Record = typename Map::mapped_type;
    std::size_t size = bytes_.Length(map.size(), LeastSize<Record>(visit));
    if constexpr (kReads) {
      for (; size > 0; --size) {
        Record record;
        visit(*this, record);
        if (!map.empty() && !(map.rbegin()->first < record.views)) {
          bytes_.Fail("pairs of views must ascend");
        }
        const ViewPair views = record.views;
        map.emplace_hint(map.end(), views, std::move(record));
      }
    } else {
      for (auto& [views, record] : map) visit(*this, record);
    }
  }

 private:
  // That of an item of which everything is empty.
  template <class Value, class Visit>
  static std::size_t LeastSize(const Visit& visit) {
    std::string bytes;
    ByteWriter writer(bytes);
    BinaryRecord<ByteWriter> record(writer);
    Value value{};
    if constexpr (IsEigen<Value>::value) value.setZero();
    visit(record, value);
    return bytes.size();
  }

  Bytes& bytes_;
};

}  // namespace lowlap
