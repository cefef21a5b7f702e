#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace lowlap::cli {

// The part of CLI11 that the commands use. It is all templates and inline
// functions, so that a file which includes it takes seconds to compile: only
// command_line.cc and main.cc do.

/// What the text of an option must be.
class Check {
 public:
  /// `test` returns what is wrong, or nothing; `name` stands for the value in
  /// help texts.
  Check(std::function<std::string(const std::string&)> test,
        const std::string& name);
  /// Finite numbers. (The checks of CLI11 name the largest double in their
  /// messages.)
  static Check Positive();
  static Check NonNegative();
  /// An integer from 0 to 2^64 - 1.
  static Check WholeNumber();
  static Check Between(int least, int greatest);
  static Check Between(double least, double greatest);
  static Check OneOf(const std::vector<std::string>& words);

  const CLI::Validator& validator() const { return *validator_; }

 private:
  explicit Check(const CLI::Validator& validator);

  std::shared_ptr<const CLI::Validator> validator_;
};

/// An option of a command; every function returns the option itself.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option Required();
  /// In the help: the value that the variable has now, or `text`.
  Option ShowDefault();
  Option ShowDefault(const std::string& text);
  /// What stands for the value in help texts.
  Option ShowType(const std::string& text);
  /// A list in one word.
  Option SeparatedBy(char separator);
  /// May stand without a value.
  Option ValueIsOptional();
  Option Must(const Check& check);
  Option Excludes(const Option& other);
  Option Needs(const Option& other);
  /// Whether the command line has it, once that is read.
  bool IsGiven() const;

 private:
  CLI::Option* option_;
};

CLI::App* AddCommand(CLI::App* program, const std::string& name,
                     const std::string& help);
/// In the help of every option that is added later.
void ShowDefaultsFromHereOn(CLI::App* command);
/// Below the options in the help of the command.
void SetFooter(CLI::App* command, const std::string& text);
/// `run` is called if the command is chosen, after its options are read.
void WhenChosen(CLI::App* command, std::function<void()> run);

/// `value` (an int, double, string, list, ...) must live as long as the
/// program.
template <class Value>
Option AddOption(CLI::App* command, const std::string& names, Value& value,
                 const std::string& help);
Option AddOption(CLI::App* command, const std::string& names,
                 std::function<void(const std::vector<std::string>&)> set,
                 const std::string& help);
Option AddFlag(CLI::App* command, const std::string& names, bool& value,
               const std::string& help);
/// The same, which tells whether it was given.
Option AddFlag(CLI::App* command, const std::string& names,
               std::optional<bool>& value, const std::string& help);
/// One that was added before.
Option FindOption(CLI::App* command, const std::string& name);

}  // namespace lowlap::cli
