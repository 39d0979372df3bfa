#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/command.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace joulepath {

/// Rules for the value of one option; calls can be chained. The help shows each rule.
class OptionRules {
 public:
  explicit OptionRules(CLI::Option& option) : option_(&option) {}
  OptionRules& required();
  OptionRules& shows_default();  ///< the member's value when it is declared
  OptionRules& between(int least, int most);
  OptionRules& between(double least, double most);
  OptionRules& not_negative();
  OptionRules& positive();
  OptionRules& existing_path();
  /// `part`: of an Addition, for the error of a word that an extension has which was not built.
  OptionRules& one_of(const std::vector<std::string>& words, const std::string& part = {});
  OptionRules& comma_separated();  ///< of a list: values by comma, or the option again
  OptionRules& repeatable();       ///< of a list: one value each time that the option is given

 private:
  CLI::Option* option_;
};

/// The options and arguments of one command. A name with dashes (`--out`, `-j,--jobs`) is an option, one
/// without dashes a positional argument. The value is unchanged if the option is not given.
class CommandLine {
 public:
  explicit CommandLine(CLI::App& app) : app_(&app) {}

  /// Defined for std::string, std::vector<std::string>, int, unsigned, std::size_t, double and
  /// std::optional<double>.
  template <class Value>
  OptionRules option(const std::string& name, Value& value, const std::string& says = {});

  /// Sets `value` if the flag is given; a name that begins with `!` clears it.
  void flag(const std::string& name, bool& value, const std::string& says);

 private:
  CLI::App* app_;
};

using Commands = std::vector<std::unique_ptr<Command>>;

/// The parsed arguments: a command to run, or a text to print and the exit code.
struct ParsedCommandLine {
  Command* command{};    ///< its members hold the options' values; null: nothing to run
  std::string output{};  ///< help or version: for stdout, or for stderr if exit_code is not kDone
  std::string error{};   ///< for stderr: the mistake
  std::string hint{};    ///< for stderr, below the error
  int exit_code{kDone};
  bool prints_data{};  ///< stdout is for other programs, which read whole lines
};

[[nodiscard]] ParsedCommandLine parse_command_line(int argc, const char* const* argv,
                                                   const Commands& commands, const std::string& version);

/// A command for a completion script.
struct CommandSummary {
  std::string name{};
  std::string says{};
  std::vector<std::string> flags{};  ///< `--out`, ...
};

[[nodiscard]] std::vector<CommandSummary> summaries(const Commands& commands);

}  // namespace joulepath
