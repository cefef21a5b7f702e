#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lowlap/io/internal/json/json_value.h"
#include "lowlap/io/internal/record_traits.h"

namespace lowlap {

inline void Read(const JsonValue& json, double& value) { value = json.Real(); }
inline void Read(const JsonValue& json, int& value) { value = json.Count(); }
inline void Read(const JsonValue& json, std::uint32_t& value) {
  value = json.Id();
}
template <class Thing>
void Read(const JsonValue& json, Id<Thing>& value) {
  value = json.Id();
}
inline void Read(const JsonValue& json, std::string& value) {
  value = json.String();
}
template <int kRows, int kCols>
void Read(const JsonValue& json, Eigen::Matrix<double, kRows, kCols>& value) {
  if constexpr (kCols == 1) {
    value = json.Vector<kRows>();
  } else {
    value = json.Matrix<kRows, kCols>();
  }
}
void Read(const JsonValue& json, std::vector<double>& value);
void Read(const JsonValue& json, ViewPair& views);
void Read(const JsonValue& json, ViewTriplet& views);
void Read(const JsonValue& json, CameraModel& model);
void Read(const JsonValue& json, RatioVerdict& verdict);
void Read(const JsonValue& json, PoseWeakness& weakness);

/// Takes the numbers of a flat array, one after the other; without one, counts
/// those that a visitor asks for.
class JsonFlatReader {
 public:
  JsonFlatReader() = default;
  explicit JsonFlatReader(const JsonValue& array)
      : next_(array.Elements().begin()) {}

  template <class Value>
  void Item(Value& value) {
    if constexpr (IsEigen<Value>::value) {
      for (auto& number : value.reshaped()) Item(number);
    } else {
      ++count_;
      if (!next_) return;
      Read(**next_, value);
      ++*next_;
    }
  }
  std::size_t count() const { return count_; }

 private:
  std::optional<JsonValue::Iterator> next_;
  std::size_t count_ = 0;
};

/// Takes the members of an object; without one, collects the names that a
/// visitor asks for.
class JsonRecordReader {
 public:
  static constexpr bool kIsText = true;

  JsonRecordReader() = default;
  explicit JsonRecordReader(const JsonValue& object) : object_(object) {}

  template <class Value>
  void Member(const char* name, Value& value,
              Presence presence = Presence::kAlways) {
    if (const auto member = Find(name, presence)) Read(*member, value);
  }
  template <class Value, class... Visit>
  void Optional(const char* name, std::optional<Value>& value,
                const Visit&... visit) {
    if (const auto member = Find(name, Presence::kMayBeMissing)) {
      Read(*member, value.emplace(), visit...);
    }
  }
  template <class Items, class Visit>
  void List(const char* name, Items& items, const Visit& visit,
            Presence presence = Presence::kAlways) {
    const auto list = Find(name, presence);
    if (!list) return;
    for (const JsonValue item : list->Elements()) {
      Read(item, items.emplace_back(), visit);
    }
  }
  template <class Items, class Visit>
  void Flat(const char* name, Items& items, const Visit& visit,
            Presence presence = Presence::kAlways) {
    const auto array = Find(name, presence);
    if (array) ReadFlat(*array, visit, items);
  }
  template <class Value, class Visit>
  void Object(const char* name, Value& value, const Visit& visit) {
    const auto member = Find(name, Presence::kAlways);
    if (member) Read(*member, value, visit);
  }

  const std::vector<std::string_view>& names() const { return names_; }

 private:
  std::optional<JsonValue> Find(const char* name, Presence presence) {
    if (!object_) {
      names_.emplace_back(name);
      return std::nullopt;
    }
    return presence == Presence::kAlways ? object_->At(name)
                                         : object_->Find(name);
  }

  std::optional<JsonValue> object_;
  std::vector<std::string_view> names_;
};

/// An object with the members that the visitor knows, and `key` where it has
/// one, but no others.
template <class Visit, class Value>
void Read(const JsonValue& object, Value& value, const Visit& visit,
          const char* key = nullptr) {
  JsonRecordReader known;
  Value unused{};
  visit(known, unused);
  std::vector<std::string_view> names = known.names();
  if (key != nullptr) names.emplace_back(key);
  object.AllowOnly(names);
  JsonRecordReader reader(object);
  visit(reader, value);
}

/// An array of numbers, several an item.
template <class Visit, class Items>
void ReadFlat(const JsonValue& array, const Visit& visit, Items& items) {
  JsonFlatReader counter;
  typename Items::value_type unused{};
  visit(counter, unused);
  items.resize(array.FlatSize(counter.count()) / counter.count());
  JsonFlatReader reader(array);
  for (auto& item : items) visit(reader, item);
}

}  // namespace lowlap
