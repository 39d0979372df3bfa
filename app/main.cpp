#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <new>
#include <system_error>

#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/terminal.hpp"
#include "model/assert.hpp"
#include "model/config_error.hpp"
#include "scenarios/document.hpp"

namespace joulepath {
namespace {

int tell(const std::string& message, int code, const std::string& hint = {}) {
  std::cout.flush();
  std::cerr << paint(std::cerr, Paint::error, "joulepath: ") << message << '\n';
  if (!hint.empty()) std::cerr << hint << '\n';
  return code;
}

/// Runs a command; every error ends in one message and its exit code.
int guarded(Command& command) {
  try {
    const int code = command.run();
    std::cout.flush();
    if (!std::cout) return tell("cannot write to the standard output", kEnvironment);
    return code;
  } catch (const ConfigError& error) {
    return tell(error.what(), kBadInput);
  } catch (const UsageError& error) {
    return tell(error.what(), kBadInput, "see: joulepath " + command.name() + " --help");
  } catch (const Interrupted&) {
    return tell("interrupted", kInterrupted);
  } catch (const EnvironmentError& error) {
    return tell(error.what(), kEnvironment);
  } catch (const std::filesystem::filesystem_error& error) {
    return tell(error.path1().string() + ": " + error.code().message(), kEnvironment);
  } catch (const std::system_error& error) {
    return tell(error.what(), kEnvironment);
  } catch (const std::bad_alloc&) {
    return tell("not enough memory", kEnvironment);
  } catch (const std::exception& error) {
    return tell(std::string("internal error: ") + error.what(), kInternalError,
                "This is a bug in joulepath; please report it with the command and its files.");
  }
}

std::string unknown_command_hint(int argc, char** argv,
                                 const std::vector<std::unique_ptr<Command>>& commands) {
  if (argc < 2 || argv[1][0] == '-') return "";
  std::vector<std::string> names;
  for (const auto& command : commands) names.push_back(command->name());
  for (const auto& name : names)
    if (name == argv[1]) return "";
  const std::string near = nearest_word(argv[1], names);
  return "no command '" + std::string(argv[1]) + "'" + (near.empty() ? "" : " (did you mean " + near + "?)");
}

std::string command_typed(const CLI::App& app) {
  const auto subcommands = app.get_subcommands();
  return subcommands.empty() ? "" : " " + subcommands.front()->get_name();
}

/// The nearest option of the command in use, for an argument that it does not know.
std::string unknown_argument(const std::string& argument, const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands())
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const std::string near = nearest_word(argument, names);
  return "unknown argument " + argument + (near.empty() ? "" : " (did you mean " + near + "?)");
}

int run(int argc, char** argv) {
  CLI::App app{
      "Energy-optimal trajectories, power models and sim-to-real diagnosis for differential-drive robots",
      "joulepath"};
  app.set_version_flag("--version", std::string("joulepath ") + JOULEPATH_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(32);
  app.footer(
      "Exit codes: 0 done, 1 infeasible or failed, 2 bad input or usage, 3 internal error, 4 environment, "
      "130 interrupted.\n"
      "joulepath COMMAND --help shows the options of a command, with examples.");
  const auto commands = all_commands();
  Command* chosen = nullptr;
  for (const auto& command : commands) {
    CLI::App* sub = app.add_subcommand(command->name(), command->says());
    sub->footer("Examples:\n" + command->examples());
    command->declare(*sub);
    sub->callback([&chosen, &command] { chosen = command.get(); });
  }
  if (argc < 2) {
    std::cerr << app.help();
    return kBadInput;
  }
  if (const auto message = unknown_command_hint(argc, argv, commands); !message.empty())
    return tell(message, kBadInput, "joulepath --help lists the commands");
  try {
    app.parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    // What is missing may be what was mistyped: an unknown argument is told first.
    const std::vector<std::string> extras = app.remaining(true);
    return tell(extras.empty() ? error.what() : unknown_argument(extras.front(), app), kBadInput,
                "see: joulepath" + command_typed(app) + " --help");
  } catch (const CLI::Success& success) {
    return app.exit(success, std::cout, std::cerr);
  } catch (const CLI::ExtrasError&) {
    return tell(unknown_argument(app.remaining(true).front(), app), kBadInput,
                "see: joulepath" + command_typed(app) + " --help");
  } catch (const CLI::ParseError& error) {
    return tell(error.what(), kBadInput, "see: joulepath" + command_typed(app) + " --help");
  }
  return guarded(*chosen);
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  joulepath::install_interrupt_handler();
  return joulepath::run(argc, argv);
}
