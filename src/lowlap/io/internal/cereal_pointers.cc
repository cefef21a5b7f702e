#include "lowlap/io/internal/cereal_pointers.h"

namespace lowlap {

std::string CerealPointers::TypeName(const JsonValue& pointer) {
  // Before version 0.3 views were not polymorphic.
  const std::optional<JsonValue> id_value = pointer.Find("polymorphic_id");
  if (!id_value) return {};
  const std::uint32_t id = id_value->Id();
  if (id == 0) id_value->Fail("null pointer");
  if (id == kStaticType) return {};
  if (id & kDefines) {
    return type_names_[id & ~kDefines] =
               pointer.At("polymorphic_name").String();
  }
  const auto name = type_names_.find(id);
  if (name == type_names_.end()) {
    id_value->Fail("refers to a type name that was not given before");
  }
  return name->second;
}

CerealPointers::Object CerealPointers::Resolve(const JsonValue& pointer) {
  std::string type_name = TypeName(pointer);
  const JsonValue wrapper = pointer.At("ptr_wrapper");
  const JsonValue id_value = wrapper.At("id");
  const std::uint32_t id = id_value.Id();
  if (id == 0) id_value.Fail("null pointer");
  if (id & kDefines) {
    const JsonValue data = wrapper.At("data");
    objects_.insert_or_assign(id & ~kDefines, data);
    return {std::move(type_name), data};
  }
  const auto object = objects_.find(id);
  if (object == objects_.end()) {
    id_value.Fail("refers to an object that was not given before");
  }
  return {std::move(type_name), object->second};
}

}  // namespace lowlap
