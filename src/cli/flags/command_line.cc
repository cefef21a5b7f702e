#include "cli/flags/command_line.h"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <utility>

#include "lowlap/core/internal/format.h"

namespace lowlap::cli {
namespace {

template <class Allows>
Check NumberThat(const std::string& what, const std::string& name,
                 Allows allows) {
  return Check(
      [what, allows](const std::string& text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
            allows(value)) {
          return {};
        }
        return "'" + text + "' is not a " + what;
      },
      name);
}

}  // namespace

Check::Check(const CLI::Validator& validator)
    : validator_(std::make_shared<CLI::Validator>(validator)) {}

Check::Check(std::function<std::string(const std::string&)> test,
             const std::string& name)
    : validator_(std::make_shared<CLI::Validator>(std::move(test), name)) {}

Check Check::Positive() {
  return NumberThat("positive number", "POSITIVE",
                    [](double v) { return v > 0; });
}

Check Check::NonNegative() {
  return NumberThat("non-negative number", "NONNEGATIVE",
                    [](double v) { return v >= 0; });
}

Check Check::WholeNumber() {
  return Check(
      [](const std::string& text) -> std::string {
        const bool has_digit =
            !text.empty() && text[0] >= '0' && text[0] <= '9';
        errno = 0;
        char* end = nullptr;
        std::strtoull(text.c_str(), &end, 0);
        if (has_digit && *end == '\0' && errno == 0) return {};
        return "'" + text + "' is not a non-negative number of at most 64 bits";
      },
      "WHOLE");
}

Check Check::Between(int least, int greatest) {
  return Check(CLI::Range(least, greatest));
}

Check Check::Between(double least, double greatest) {
  return NumberThat(Format("number from %g to %g", least, greatest),
                    Format("FLOAT in [%g - %g]", least, greatest),
                    [=](double v) { return v >= least && v <= greatest; });
}

Check Check::OneOf(const std::vector<std::string>& words) {
  return Check(CLI::IsMember(words));
}

Option Option::Required() {
  option_->required();
  return *this;
}

Option Option::ShowDefault() {
  option_->capture_default_str();
  return *this;
}

Option Option::ShowDefault(const std::string& text) {
  option_->default_str(text);
  return *this;
}

Option Option::ShowType(const std::string& text) {
  option_->type_name(text);
  return *this;
}

Option Option::SeparatedBy(char separator) {
  // One word; the next is another argument.
  option_->delimiter(separator)->allow_extra_args(false);
  return *this;
}

Option Option::ValueIsOptional() {
  option_->expected(0, 1);
  return *this;
}

Option Option::Must(const Check& check) {
  option_->check(check.validator());
  return *this;
}

Option Option::Excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option Option::Needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

bool Option::IsGiven() const { return option_->count() > 0; }

CLI::App* AddCommand(CLI::App* program, const std::string& name,
                     const std::string& help) {
  return program->add_subcommand(name, help);
}

void ShowDefaultsFromHereOn(CLI::App* command) {
  command->option_defaults()->always_capture_default();
}

void SetFooter(CLI::App* command, const std::string& text) {
  command->footer(text);
}

void WhenChosen(CLI::App* command, std::function<void()> run) {
  command->callback(std::move(run));
}

template <class Value>
Option AddOption(CLI::App* command, const std::string& names, Value& value,
                 const std::string& help) {
  return Option(command->add_option(names, value, help));
}

#define LOWLAP_OPTION(Value)                                       \
  template Option AddOption(CLI::App*, const std::string&, Value&, \
                            const std::string&)
LOWLAP_OPTION(int);
LOWLAP_OPTION(double);
LOWLAP_OPTION(std::uint64_t);
LOWLAP_OPTION(std::string);
LOWLAP_OPTION(std::optional<double>);
LOWLAP_OPTION(std::optional<std::string>);
LOWLAP_OPTION(std::vector<double>);
LOWLAP_OPTION(std::vector<std::string>);
#undef LOWLAP_OPTION

Option AddOption(CLI::App* command, const std::string& names,
                 std::function<void(const std::vector<std::string>&)> set,
                 const std::string& help) {
  return Option(command->add_option_function(names, std::move(set), help));
}

Option AddFlag(CLI::App* command, const std::string& names, bool& value,
               const std::string& help) {
  return Option(command->add_flag(names, value, help));
}

Option AddFlag(CLI::App* command, const std::string& names,
               std::optional<bool>& value, const std::string& help) {
  CLI::Option* option = command->add_flag_function(
      names, [&value](std::int64_t sign) { value = sign > 0; }, help);
  option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  return Option(option).Must(Check(
      [](const std::string& text) -> std::string {
        bool known = false;
        return CLI::detail::lexical_cast(text, known)
                   ? ""
                   : "'" + text + "' is neither true nor false";
      },
      ""));
}

Option FindOption(CLI::App* command, const std::string& name) {
  return Option(command->get_option(name));
}

}  // namespace lowlap::cli
