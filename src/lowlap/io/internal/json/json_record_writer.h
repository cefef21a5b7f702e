#pragma once

#include <optional>
#include <string>

#include "lowlap/io/internal/json/json_text.h"
#include "lowlap/io/internal/record_traits.h"

namespace lowlap {

/// Appends the members of an object, or the items of a flat array, for the
/// visitors of scene_records.h.
class JsonRecordWriter {
 public:
  static constexpr bool kIsText = true;

  explicit JsonRecordWriter(std::string& text) : text_(text) {}

  template <class Value>
  void Item(const Value& value) {
    if constexpr (IsEigen<Value>::value) {
      AppendElements(value, text_);
    } else {
      AppendComma(text_);
      AppendValue(value, text_);
    }
  }
  template <class Value>
  void Member(const char* name, const Value& value,
              Presence = Presence::kAlways) {
    if constexpr (std::is_enum_v<Value>) {
      AppendMember(name, NameOf(value), text_);
    } else {
      AppendMember(name, value, text_);
    }
  }
  template <class Value>
  void Optional(const char* name, const std::optional<Value>& value) {
    if (value) Member(name, *value);
  }
  template <class Value, class Visit>
  void Optional(const char* name, const std::optional<Value>& value,
                const Visit& visit) {
    if (!value) return;
    AppendKey(name, text_);
    Object(*value, visit);
  }
  template <class Items, class Visit>
  void List(const char* name, const Items& items, const Visit& visit,
            Presence presence = Presence::kAlways) {
    const auto object = [&](JsonRecordWriter&, const auto& item) {
      AppendComma(text_);
      Object(item, visit);
    };
    Flat(name, items, object, presence);
  }
  template <class Items, class Visit>
  void Flat(const char* name, const Items& items, const Visit& visit,
            Presence presence = Presence::kAlways) {
    if (items.empty() && presence == Presence::kMayBeMissing) return;
    AppendKey(name, text_);
    text_ += '[';
    for (const auto& item : items) visit(*this, item);
    text_ += ']';
  }
  template <class Value, class Visit>
  void Object(const Value& value, const Visit& visit) {
    text_ += '{';
    visit(*this, value);
    text_ += '}';
  }

 private:
  std::string& text_;
};

}  // namespace lowlap
