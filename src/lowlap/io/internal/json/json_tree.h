#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap {

enum class JsonKind : std::uint32_t {
  kNull,
  kBool,
  kUnsigned,
  kNegative,
  kReal,
  kString,
  kArray,
  kObject,
};

/// One value of a JSON text, 16 bytes. The children of an array or object are
/// the nodes that follow it, up to `end`.
struct JsonNode {
  std::uint32_t key = 0;  // index of the member's name; 0 outside objects
  JsonKind kind = JsonKind::kNull;
  union {
    std::uint64_t unsigned_value = 0;
    std::int64_t negative_value;
    double real_value;
    bool bool_value;
    std::uint32_t string_index;
    std::uint32_t end;  // of a container: one past its last descendant
  };

  bool IsContainer() const {
    return kind == JsonKind::kArray || kind == JsonKind::kObject;
  }
};

/// A whole JSON text in the order of the text. This form is compact, keeps
/// repeated keys from passing unseen, and knows the path of every value.
struct JsonTree {
  std::vector<JsonNode> nodes;
  std::vector<std::string> strings;
  std::vector<std::string> keys = {""};

  /// The node after `index` and its descendants.
  std::uint32_t Next(std::uint32_t index) const {
    return nodes[index].IsContainer() ? nodes[index].end : index + 1;
  }

  /// The path of a node in the notation of sfm_data/FORMAT.md, such as
  /// `$.views[key=3].id_intrinsic`.
  std::string PathOf(std::uint32_t index) const;
};

/// Errors: kParse with `place` "line L, column C", or, for a repeated key, its
/// path.
Result<JsonTree> ParseJson(const std::string& text);

}  // namespace lowlap
