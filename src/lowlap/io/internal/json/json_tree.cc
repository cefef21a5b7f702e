#include "lowlap/io/internal/json/json_tree.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <unordered_map>

namespace lowlap {
namespace {

constexpr std::uint32_t kOpen = std::numeric_limits<std::uint32_t>::max();

std::string LineAndColumn(const std::string& text, std::size_t offset) {
  const auto end = text.begin() + std::min(offset, text.size());
  const auto line = std::count(text.begin(), end, '\n') + 1;
  const auto line_start =
      std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
  return "line " + std::to_string(line) + ", column " +
         std::to_string(end - line_start + 1);
}

// The literal that programs write for a number that is not finite, if one
// ends, begins or lies around `offset`.
std::optional<std::string> NonFiniteLiteral(const std::string& text,
                                            std::size_t offset) {
  const std::size_t begin = offset < 2 ? 0 : offset - 2;
  const std::string_view around =
      std::string_view(text).substr(std::min(begin, text.size()), 12);
  for (const char* literal :
       {"-Infinity", "Infinity", "NaN", "-inf", "inf", "nan"}) {
    const std::size_t found = around.find(literal);
    if (found <= 2) return literal;
  }
  return std::nullopt;
}

// Receives the events of nlohmann's parser and appends nodes.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(const std::string& text, JsonTree& tree)
      : text_(text), tree_(tree) {}

  const std::optional<Error>& error() const { return error_; }

  bool null() override { return Add(JsonKind::kNull) != nullptr; }
  bool boolean(bool value) override {
    JsonNode* node = Add(JsonKind::kBool);
    if (node) node->bool_value = value;
    return node;
  }
  bool number_integer(number_integer_t value) override {
    JsonNode* node = Add(JsonKind::kNegative);
    if (node) node->negative_value = value;
    return node;
  }
  bool number_unsigned(number_unsigned_t value) override {
    JsonNode* node = Add(JsonKind::kUnsigned);
    if (node) node->unsigned_value = value;
    return node;
  }
  bool number_float(number_float_t value, const string_t&) override {
    JsonNode* node = Add(JsonKind::kReal);
    if (node) node->real_value = value;
    return node;
  }
  bool string(string_t& value) override {
    JsonNode* node = Add(JsonKind::kString);
    if (!node) return false;
    node->string_index = static_cast<std::uint32_t>(tree_.strings.size());
    tree_.strings.push_back(std::move(value));
    return true;
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return Open(JsonKind::kObject); }
  bool end_object() override { return Close(); }
  bool start_array(std::size_t) override { return Open(JsonKind::kArray); }
  bool end_array() override { return Close(); }

  bool key(string_t& value) override {
    const auto [entry, is_new] = key_index_.try_emplace(
        value, static_cast<std::uint32_t>(tree_.keys.size()));
    if (is_new) tree_.keys.push_back(value);
    pending_key_ = entry->second;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::json::exception& exception) override {
    const std::size_t offset = position == 0 ? 0 : position - 1;
    Error error{ErrorCode::kParse, {}, {}, LineAndColumn(text_, offset)};
    if (const auto literal = NonFiniteLiteral(text_, offset);
        literal && Add(JsonKind::kNull)) {
      const auto last = static_cast<std::uint32_t>(tree_.nodes.size() - 1);
      error.message =
          *literal + " is not a finite number, at " + tree_.PathOf(last);
    } else {
      // The parser's own words, without its prefix and position.
      const std::string what = exception.what();
      std::size_t begin = what.find("] ");
      begin = begin == std::string::npos ? 0 : begin + 2;
      if (const std::size_t colon = what.find(": ", begin);
          colon != std::string::npos) {
        begin = colon + 2;
      }
      error.message = what.substr(begin);
    }
    error_ = std::move(error);
    return false;
  }

 private:
  JsonNode* Add(JsonKind kind) {
    if (tree_.nodes.size() >= kOpen) {
      error_ = Error{ErrorCode::kParse, "the text has too many values", {}, {}};
      return nullptr;
    }
    JsonNode& node = tree_.nodes.emplace_back();
    node.kind = kind;
    node.key = pending_key_;
    pending_key_ = 0;
    return &node;
  }

  bool Open(JsonKind kind) {
    JsonNode* node = Add(kind);
    if (!node) return false;
    node->end = kOpen;
    open_.push_back(static_cast<std::uint32_t>(tree_.nodes.size() - 1));
    return true;
  }

  bool Close() {
    const std::uint32_t index = open_.back();
    open_.pop_back();
    JsonNode& node = tree_.nodes[index];
    node.end = static_cast<std::uint32_t>(tree_.nodes.size());
    return node.kind == JsonKind::kArray || KeysDiffer(index);
  }

  bool KeysDiffer(std::uint32_t object) {
    siblings_.clear();
    for (std::uint32_t child = object + 1; child < tree_.nodes[object].end;
         child = tree_.Next(child)) {
      siblings_.emplace_back(tree_.nodes[child].key, child);
    }
    std::sort(siblings_.begin(), siblings_.end());
    const auto repeated = std::adjacent_find(
        siblings_.begin(), siblings_.end(),
        [](const auto& a, const auto& b) { return a.first == b.first; });
    if (repeated == siblings_.end()) return true;
    error_ = Error{ErrorCode::kParse,
                   "key \"" + tree_.keys[repeated->first] + "\" is repeated",
                   {},
                   tree_.PathOf(std::next(repeated)->second)};
    return false;
  }

  const std::string& text_;
  JsonTree& tree_;
  std::unordered_map<std::string, std::uint32_t> key_index_;
  std::uint32_t pending_key_ = 0;
  std::vector<std::uint32_t> open_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> siblings_;
  std::optional<Error> error_;
};

}  // namespace

Result<JsonTree> ParseJson(const std::string& text) {
  JsonTree tree;
  TreeBuilder builder(text, tree);
  if (nlohmann::json::sax_parse(text.data(), text.data() + text.size(),
                                &builder)) {
    return tree;
  }
  return tl::unexpected<Error>(
      builder.error().value_or(Error{ErrorCode::kParse, "malformed", {}, {}}));
}

}  // namespace lowlap
