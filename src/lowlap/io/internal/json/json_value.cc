#include "lowlap/io/internal/json/json_value.h"

#include <algorithm>
#include <limits>

namespace lowlap {
namespace {

std::string Quoted(std::string_view text) {
  return "\"" + std::string(text) + "\"";
}

}  // namespace

void JsonValue::Fail(std::string message, ErrorCode code) const {
  throw Failure{Error{code, std::move(message), {}, tree_->PathOf(index_)}};
}

void JsonValue::FailSize(int expected, int actual) const {
  Fail("must have " + std::to_string(expected) + " elements, not " +
       std::to_string(actual));
}

void JsonValue::RequireObject() const {
  if (node().kind != JsonKind::kObject) Fail("must be an object");
}

std::optional<JsonValue> JsonValue::Find(std::string_view name) const {
  RequireObject();
  for (std::uint32_t child = index_ + 1; child < node().end;
       child = tree_->Next(child)) {
    if (tree_->keys[tree_->nodes[child].key] == name) {
      return JsonValue(*tree_, child);
    }
  }
  return std::nullopt;
}

JsonValue JsonValue::At(std::string_view name) const {
  const std::optional<JsonValue> member = Find(name);
  if (!member) Fail("key " + Quoted(name) + " is missing");
  return *member;
}

void JsonValue::AllowOnly(const std::vector<std::string_view>& names) const {
  RequireObject();
  for (std::uint32_t child = index_ + 1; child < node().end;
       child = tree_->Next(child)) {
    const std::string& key = tree_->keys[tree_->nodes[child].key];
    if (std::find(names.begin(), names.end(), key) == names.end()) {
      JsonValue(*tree_, child).Fail("key " + Quoted(key) + " is not known");
    }
  }
}

std::uint64_t JsonValue::Integer(std::uint64_t largest) const {
  const JsonNode& n = node();
  if (n.kind == JsonKind::kUnsigned && n.unsigned_value <= largest) {
    return n.unsigned_value;
  }
  std::string actual;
  if (n.kind == JsonKind::kUnsigned) {
    actual = ", not " + std::to_string(n.unsigned_value);
  } else if (n.kind == JsonKind::kNegative) {
    actual = ", not " + std::to_string(n.negative_value);
  }
  Fail("must be an integer between 0 and " + std::to_string(largest) + actual);
}

std::uint32_t JsonValue::Id() const {
  return static_cast<std::uint32_t>(
      Integer(std::numeric_limits<std::uint32_t>::max()));
}

int JsonValue::Count() const {
  return static_cast<int>(Integer(std::numeric_limits<int>::max()));
}

double JsonValue::Real() const {
  switch (node().kind) {
    case JsonKind::kReal:
      return node().real_value;
    case JsonKind::kUnsigned:
      return static_cast<double>(node().unsigned_value);
    case JsonKind::kNegative:
      return static_cast<double>(node().negative_value);
    default:
      Fail("must be a number");
  }
}

bool JsonValue::Bool() const {
  if (node().kind != JsonKind::kBool) Fail("must be true or false");
  return node().bool_value;
}

const std::string& JsonValue::String() const {
  if (node().kind != JsonKind::kString) Fail("must be a string");
  return tree_->strings[node().string_index];
}

JsonValue::Range JsonValue::Elements() const {
  if (node().kind != JsonKind::kArray) Fail("must be an array");
  return {Iterator(*tree_, index_ + 1), Iterator(*tree_, node().end)};
}

std::size_t JsonValue::FlatSize(std::size_t stride) const {
  std::size_t size = 0;
  for (const JsonValue element : Elements()) {
    if (element.node().IsContainer()) element.Fail("must be a number");
    ++size;
  }
  if (size % stride != 0) {
    Fail("must hold a multiple of " + std::to_string(stride) +
         " numbers, not " + std::to_string(size));
  }
  return size;
}

}  // namespace lowlap
