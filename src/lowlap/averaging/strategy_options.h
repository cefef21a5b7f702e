#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap {

/// Options of a strategy as text, by key.
using OptionValues = std::map<std::string, std::string>;

/// An option that a strategy has, for people.
struct StrategyOption {
  std::string key;
  std::string default_value;
  std::string description;
};

std::string OptionText(int value);
std::string OptionText(std::size_t value);
/// With as many digits as it takes to read the same value back.
std::string OptionText(double value);
std::string OptionText(bool value);
std::string OptionText(const std::string& value);

/// kInvalidArgument, naming the key, if the text is no such value; `value` is
/// unchanged then.
Status ReadOption(const std::string& key, const std::string& text, int* value);
Status ReadOption(const std::string& key, const std::string& text,
                  std::size_t* value);
Status ReadOption(const std::string& key, const std::string& text,
                  double* value);
Status ReadOption(const std::string& key, const std::string& text, bool* value);
Status ReadOption(const std::string& key, const std::string& text,
                  std::string* value);

/// "no option 'x'; known: a, b".
Error UnknownOption(const std::string& key,
                    const std::vector<StrategyOption>& known);

/// The options of a struct that has
///   Status Validate() const;
///   void VisitOptions(const Visit& visit)   (a template of Visit)
/// which calls visit("key", pointer to the member, "what it is") for each.
template <class Options>
std::vector<StrategyOption> ListOptions(Options defaults) {
  std::vector<StrategyOption> list;
  defaults.VisitOptions(
      [&](const char* key, auto* member, const char* description) {
        list.push_back({key, OptionText(*member), description});
      });
  return list;
}

/// `defaults` with the given values, valid. kInvalidArgument otherwise, with
/// the known keys for one that is unknown.
template <class Options>
Result<Options> ReadOptions(OptionValues values, const Options& defaults) {
  Options options = defaults;
  Status status;
  options.VisitOptions([&](const char* key, auto* member, const char*) {
    const auto found = values.find(key);
    if (found == values.end()) return;
    if (status) status = ReadOption(key, found->second, member);
    values.erase(found);
  });
  if (!values.empty()) {
    return tl::unexpected<Error>(
        UnknownOption(values.begin()->first, ListOptions(defaults)));
  }
  if (status) status = options.Validate();
  if (!status) return tl::unexpected<Error>(status.error());
  return options;
}

}  // namespace lowlap
