#include "app/program.hpp"

#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <system_error>

#include "app/build_id.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/terminal.hpp"
#include "model/assert.hpp"
#include "model/config_error.hpp"
#include "model/printable.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

int tell(const std::string& message, int code, const std::string& hint = {}) {
  std::cout.flush();
  std::cerr << paint(std::cerr, Paint::error, "joulepath: ") << printable(message) << '\n';
  if (!hint.empty()) std::cerr << hint << '\n';
  return code;
}

/// Runs a command; every error ends in one message and its exit code.
int guarded(Command& command) {
  try {
    forget_inputs();
    const int code = command.run();
    std::cout.flush();
    if (!std::cout) return tell("cannot write to the standard output", kEnvironment);
    return code;
  } catch (const ConfigError& error) {
    return tell(error.what(), kBadInput);
  } catch (const UsageError& error) {
    return tell(error.what(), kBadInput, "see: joulepath " + command.text().name + " --help");
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

}  // namespace

int program_main(int argc, char** argv) try {
  const FoldedTerminal messages(std::cerr);
  const Commands commands = all_commands();
  const std::string version = JOULEPATH_VERSION " (build " + std::string(kBuildId) + ")";
  const ParsedCommandLine parsed = parse_command_line(argc, argv, commands, version);
  if (!parsed.error.empty()) return tell(parsed.error, parsed.exit_code, parsed.hint);
  std::optional<FoldedTerminal> results;
  if (!parsed.prints_data) results.emplace(std::cout);
  if (parsed.command) return guarded(*parsed.command);
  (parsed.exit_code == kDone ? std::cout : std::cerr) << parsed.output;
  std::cout.flush();
  if (!std::cout) return tell("cannot write to the standard output", kEnvironment);
  return parsed.exit_code;
} catch (const std::bad_alloc&) {  // of the command line; guarded() reports those of a command
  return tell("not enough memory", kEnvironment);
}

}  // namespace joulepath
