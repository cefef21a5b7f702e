#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "lowlap/io/internal/json/json_value.h"

namespace lowlap {

/// Resolves the polymorphic shared pointers of a cereal JSON archive:
///   {"polymorphic_id": p, "polymorphic_name": name,
///    "ptr_wrapper": {"id": n, "data": object}}
/// where an id with the top bit set defines a type name, or an object, and one
/// without refers to what was defined before.
class CerealPointers {
 public:
  /// p without a name: the object has the pointer's static type.
  static constexpr std::uint32_t kStaticType = 0x40000000u;
  static constexpr std::uint32_t kDefines = 0x80000000u;

  struct Object {
    std::string type_name;  // empty: the static type
    JsonValue data;
  };

  Object Resolve(const JsonValue& pointer);

 private:
  std::string TypeName(const JsonValue& pointer);

  std::map<std::uint32_t, std::string> type_names_;
  std::map<std::uint32_t, JsonValue> objects_;
};

}  // namespace lowlap
