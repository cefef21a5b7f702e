#include <array>
#include <cstring>
#include <optional>

#include "lowlap/io/internal/json/json_tree.h"

namespace lowlap {
namespace {

std::optional<std::string> IntegerText(const JsonNode& node) {
  if (node.kind == JsonKind::kUnsigned) {
    return std::to_string(node.unsigned_value);
  }
  if (node.kind == JsonKind::kNegative) {
    return std::to_string(node.negative_value);
  }
  return std::nullopt;
}

// "3", or "0,1" for an array of integers.
std::optional<std::string> IdText(const JsonTree& tree, std::uint32_t index,
                                  std::uint32_t limit) {
  if (tree.nodes[index].kind != JsonKind::kArray) {
    return IntegerText(tree.nodes[index]);
  }
  std::string text;
  for (std::uint32_t child = index + 1; child < limit;
       child = tree.Next(child)) {
    const std::optional<std::string> part = IntegerText(tree.nodes[child]);
    if (!part) return std::nullopt;
    text += (text.empty() ? "" : ",") + *part;
  }
  return text;
}

// "key=3" for a record of a list: the member that tells it from the others.
std::optional<std::string> RecordName(const JsonTree& tree,
                                      std::uint32_t record,
                                      std::uint32_t limit) {
  if (tree.nodes[record].kind != JsonKind::kObject) return std::nullopt;
  for (const char* name : {"key", "id", "view", "views"}) {
    for (std::uint32_t child = record + 1; child < limit;
         child = tree.Next(child)) {
      if (tree.keys[tree.nodes[child].key] != name) continue;
      const std::uint32_t end = std::min(limit, tree.Next(child));
      if (const auto id = IdText(tree, child, end)) {
        return std::string(name) + "=" + *id;
      }
    }
  }
  return std::nullopt;
}

// The wrappers that OpenMVG's serialisation puts around every record.
bool IsWrapper(const std::string& key) {
  return key == "value" || key == "ptr_wrapper" || key == "data";
}

}  // namespace

std::string JsonTree::PathOf(std::uint32_t index) const {
  std::string path = "$";
  std::uint32_t parent = 0;
  const auto limit = static_cast<std::uint32_t>(nodes.size());
  while (parent != index) {
    std::uint32_t child = parent + 1;
    std::size_t position = 0;
    while (Next(child) <= index) {
      child = Next(child);
      ++position;
    }
    if (nodes[parent].kind == JsonKind::kObject) {
      const std::string& key = keys[nodes[child].key];
      if (!IsWrapper(key)) path += "." + key;
    } else {
      const auto name = RecordName(*this, child, std::min(limit, Next(child)));
      path += "[" + name.value_or(std::to_string(position)) + "]";
    }
    parent = child;
  }
  return path;
}

}  // namespace lowlap
