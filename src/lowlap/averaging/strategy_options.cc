#include "lowlap/averaging/strategy_options.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace lowlap {
namespace {

Status NotA(const char* kind, const std::string& key, const std::string& text) {
  return MakeError(ErrorCode::kInvalidArgument,
                   "option '" + key + "': '" + text + "' is not " + kind);
}

template <class Number>
Status ReadNumber(const char* kind, const std::string& key,
                  const std::string& text, Number* value) {
  Number read = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, read);
  if (error != std::errc() || rest != end ||
      std::isnan(static_cast<double>(read))) {
    return NotA(kind, key, text);
  }
  *value = read;
  return {};
}

}  // namespace

std::string OptionText(int value) { return std::to_string(value); }
std::string OptionText(std::size_t value) { return std::to_string(value); }

std::string OptionText(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::string OptionText(bool value) { return value ? "true" : "false"; }
std::string OptionText(const std::string& value) { return value; }

Status ReadOption(const std::string& key, const std::string& text, int* value) {
  return ReadNumber("a whole number", key, text, value);
}

Status ReadOption(const std::string& key, const std::string& text,
                  std::size_t* value) {
  return ReadNumber("a whole number that is not negative", key, text, value);
}

Status ReadOption(const std::string& key, const std::string& text,
                  double* value) {
  return ReadNumber("a number", key, text, value);
}

Status ReadOption(const std::string& key, const std::string& text,
                  bool* value) {
  if (text != "true" && text != "false") {
    return NotA("true or false", key, text);
  }
  *value = text == "true";
  return {};
}

Status ReadOption(const std::string&, const std::string& text,
                  std::string* value) {
  *value = text;
  return {};
}

Error UnknownOption(const std::string& key,
                    const std::vector<StrategyOption>& known) {
  std::string keys;
  for (const StrategyOption& option : known) {
    keys += (keys.empty() ? "" : ", ") + option.key;
  }
  return {ErrorCode::kInvalidArgument,
          "no option '" + key + "'; known: " + (keys.empty() ? "none" : keys),
          {},
          {}};
}

}  // namespace lowlap
