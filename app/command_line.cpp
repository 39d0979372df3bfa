#include "app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <type_traits>

#include "app/terminal.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kHelpColumn = 32;  ///< where descriptions begin

std::vector<std::string> flags_of(const CLI::App& app) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  return flags;
}

/// The program's parser with all commands declared; `chosen` is set by parsing.
std::unique_ptr<CLI::App> make_parser(const Commands& commands, Command*& chosen) {
  auto app = std::make_unique<CLI::App>(
      "Energy-optimal trajectories, power models and sim-to-real diagnosis for differential-drive robots",
      "joulepath");
  app->require_subcommand(1);
  app->get_formatter()->column_width(kHelpColumn);
  app->footer(
      "Exit codes: 0 done, 1 infeasible or failed, 2 bad input or usage, 3 internal error, 4 environment,\n"
      "130 interrupted.\n"
      "joulepath COMMAND --help shows the options of a command, with examples.");
  for (const auto& command : commands) {
    CLI::App* sub = app->add_subcommand(command->text().name, command->text().says);
    sub->footer("Examples:\n" + command->text().examples);
    if (!command->extension().empty()) sub->group("Extension " + command->extension());
    CommandLine line(*sub);
    command->declare(line);
    sub->callback([&chosen, &command] { chosen = command.get(); });
  }
  return app;
}

/// The words that a shortened one begins: `--price` of `--price-per-kWh`.
std::vector<std::string> words_begun(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t kTellingLetters = 3;
  std::vector<std::string> words;
  if (word.size() < kTellingLetters + std::min(word.find_first_not_of('-'), word.size())) return words;
  std::ranges::copy_if(known, std::back_inserter(words),
                       [&](const std::string& one) { return one.starts_with(word); });
  return words;
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
  const std::vector<std::string> begun = words_begun(word, known);
  const std::string near = begun.empty() ? nearest_word(word, known) : text_of_list(begun, " or ");
  return near.empty() ? "" : " (did you mean " + near + "?)";
}

/// A word of an extension that this program was built without.
std::string absent_text(const std::string& found, std::string_view extension) {
  return "found " + found + ", accepted: " + accepted_extension(extension) + " (" +
         extension_hint(extension) + ")";
}

std::string unknown_command(int argc, const char* const* argv, const Commands& commands) {
  if (argc < 2 || argv[1][0] == '-') return "";
  std::vector<std::string> names;
  for (const auto& command : commands) names.push_back(command->text().name);
  for (const auto& name : names)
    if (name == argv[1]) return "";
  if (const auto extension = absent_extension("command", argv[1]); !extension.empty())
    return absent_text("command " + std::string(argv[1]), extension);
  return "no command '" + std::string(argv[1]) + "'" + did_you_mean(argv[1], names);
}

/// The option of the current command that is nearest to an unknown argument.
std::string unknown_argument(const CLI::App& app) {
  const std::string argument = app.remaining(true).front();
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands())
    for (const std::string& flag : flags_of(*command)) names.push_back(flag);
  if (std::find(names.begin(), names.end(), argument) != names.end())
    return "found " + argument + " before the command, accepted: options after the command's name";
  for (const CLI::App* command : app.get_subcommands())
    if (const auto extension = absent_extension("option", command->get_name() + " " + argument);
        !extension.empty())
      return absent_text(argument, extension);
  if (std::filesystem::exists(argument))
    return "found " + argument +
           ", one file too many, accepted: one (a dataset file lists several logs; `batch` plans "
           "several missions)";
  return "unknown argument " + argument + did_you_mean(argument, names);
}

/// Whether --json is given.
bool prints_data(const CLI::App& app) {
  bool asked = false;
  for (const CLI::App* command : app.get_subcommands())
    for (const CLI::Option* option : command->get_options())
      asked = asked || (option->check_lname("json") && option->count() > 0);
  return asked;
}

/// A check of a finite number whose message says what was found and what is accepted.
CLI::Validator number_check(const std::string& accepted, bool (*fits)(double)) {
  const auto check = [accepted, fits](const std::string& text) {
    const std::optional<double> value = parse_number(text);
    return value && std::isfinite(*value) && fits(*value) ? std::string()
                                                          : "found " + text + ", accepted: " + accepted;
  };
  return {check, ""};
}

/// A script's variable that is not set gives an empty text. A name with a line break would forge a line
/// wherever it is printed.
CLI::Validator text_check() {
  const auto check = [](const std::string& text) -> std::string {
    if (text.empty()) return "found an empty text, accepted: a value";
    return keeps_its_line(text) ? "" : "found '" + printable(text) + "', accepted: no control characters";
  };
  return {check, ""};
}

ParsedCommandLine usage_error(const std::string& message, const CLI::App& app) {
  const auto typed = app.get_subcommands();
  const std::string command = typed.empty() ? "" : " " + typed.front()->get_name();
  return {.error = message, .hint = "see: joulepath" + command + " --help", .exit_code = kBadInput};
}

}  // namespace

OptionRules& OptionRules::required() {
  option_->required();
  return *this;
}

OptionRules& OptionRules::shows_default() {
  option_->capture_default_str();
  return *this;
}

OptionRules& OptionRules::between(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

OptionRules& OptionRules::between(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

OptionRules& OptionRules::not_negative() {
  *option_->get_validator() =
      number_check("a finite number of at least 0", [](double value) { return value >= 0; });
  return *this;
}

OptionRules& OptionRules::positive() {
  *option_->get_validator() = number_check("a finite number above 0", [](double value) { return value > 0; });
  return *this;
}

OptionRules& OptionRules::existing_path() {
  option_->check(CLI::ExistingPath);
  return *this;
}

OptionRules& OptionRules::one_of(const std::vector<std::string>& words, const std::string& part) {
  const CLI::IsMember member(words);
  const auto check = [member, part, words](std::string& text) {
    const auto extension = absent_extension(part, text);
    if (!extension.empty()) return absent_text(text, extension);
    const std::string refusal = member(text);
    return refusal.empty() ? refusal : refusal + did_you_mean(text, words);
  };
  option_->check(CLI::Validator(check, member.get_description()));
  return *this;
}

OptionRules& OptionRules::comma_separated() {
  option_->delimiter(',')->allow_extra_args(false);
  return *this;
}

OptionRules& OptionRules::repeatable() {
  option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

template <class Value>
OptionRules CommandLine::option(const std::string& name, Value& value, const std::string& says) {
  CLI::Option& option = *app_->add_option(name, value, says);
  // No range refuses a NaN by itself; a rule with words of its own takes the place of this check.
  if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>>)
    option.check(number_check("a finite number", [](double) { return true; }));
  else if constexpr (!std::is_integral_v<Value>)
    option.check(text_check());
  return OptionRules(option);
}

template OptionRules CommandLine::option(const std::string&, std::string&, const std::string&);
template OptionRules CommandLine::option(const std::string&, std::vector<std::string>&, const std::string&);
template OptionRules CommandLine::option(const std::string&, int&, const std::string&);
template OptionRules CommandLine::option(const std::string&, unsigned&, const std::string&);
template OptionRules CommandLine::option(const std::string&, std::size_t&, const std::string&);
template OptionRules CommandLine::option(const std::string&, double&, const std::string&);
template OptionRules CommandLine::option(const std::string&, std::optional<double>&, const std::string&);

void CommandLine::flag(const std::string& name, bool& value, const std::string& says) {
  app_->add_flag(name, value, says);
}

ParsedCommandLine parse_command_line(int argc, const char* const* argv, const Commands& commands,
                                     const std::string& version) {
  ParsedCommandLine parsed;
  const auto app = make_parser(commands, parsed.command);
  app->set_version_flag("--version", "joulepath " + version);
  if (argc < 2) return {.output = folded(app->help(), kHelpColumn), .exit_code = kBadInput};
  if (std::string_view(argv[1]) == "help") {  // `help plan` is `plan --help`
    const char* const asked[] = {argv[0], argc > 2 ? argv[2] : "--help", "--help"};
    return parse_command_line(argc > 2 ? 3 : 2, asked, commands, version);
  }
  if (const auto message = unknown_command(argc, argv, commands); !message.empty())
    return {.error = message, .hint = "joulepath --help lists the commands", .exit_code = kBadInput};
  try {
    app->parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // A missing argument may be a mistyped one: an unknown argument is reported first.
    return usage_error(app->remaining(true).empty() ? error.what() : unknown_argument(*app), *app);
  } catch (const CLI::ValidationError& error) {
    // The value of a mistyped option may have been taken as one more file.
    return usage_error(app->remaining(true).empty() ? error.what() : unknown_argument(*app), *app);
  } catch (const CLI::Success& success) {
    std::ostringstream output;
    const int code = app->exit(success, output, output);
    return {.output = folded(output.str(), kHelpColumn), .exit_code = code};
  } catch (const CLI::ExtrasError&) {
    return usage_error(unknown_argument(*app), *app);
  } catch (const CLI::ParseError& error) {
    return usage_error(error.what(), *app);
  }
  parsed.prints_data = prints_data(*app);
  return parsed;
}

std::vector<CommandSummary> summaries(const Commands& commands) {
  Command* chosen = nullptr;
  const auto app = make_parser(commands, chosen);
  std::vector<CommandSummary> list;
  for (const CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; }))
    list.push_back({command->get_name(), command->get_description(), flags_of(*command)});
  return list;
}

}  // namespace joulepath
