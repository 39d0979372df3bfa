#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace joulepath {

class CommandLine;

/// Exit codes of the program; the same for every command.
enum ExitCode : int {
  kDone = 0,
  kInfeasibleOrFailed = 1,  ///< also: a gap found with --fail-on-gap
  kBadInput = 2,            ///< usage, input, or output exists
  kInternalError = 3,
  kEnvironment = 4,  ///< disk, permission, memory
  kInterrupted = 130
};

/// A failure of the environment (disk, permission, memory), not of the input or of the program.
class EnvironmentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A mistake in the command line that the parser cannot detect.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Help text of a command.
struct CommandText {
  std::string name{};
  std::string says{};      ///< one line for the list of commands
  std::string examples{};  ///< shown below the options
};

/// One line of examples; empty for an empty one. Extensions add theirs to the core's commands.
[[nodiscard]] inline std::string example_line(const std::string& command, const std::string& arguments) {
  return arguments.empty() ? "" : "  joulepath " + command + " " + arguments + "\n";
}

/// One subcommand. `declare` adds options bound to its members. `run` reads, calculates, prints results on
/// stdout and messages on stderr, and returns the exit code. Errors are thrown; program.cpp reports them.
class Command {
 public:
  explicit Command(CommandText text) : text_(std::move(text)) {}
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;
  virtual ~Command() = default;

  [[nodiscard]] const CommandText& text() const { return text_; }
  virtual void declare(CommandLine& line) = 0;
  [[nodiscard]] virtual int run() = 0;

  /// The extension that adds the command; empty: the core.
  [[nodiscard]] const std::string& extension() const { return extension_; }
  void belongs_to(std::string extension) { extension_ = std::move(extension); }

 private:
  CommandText text_;
  std::string extension_{};
};

/// The flags that most commands share.
struct CommonOptions {
  bool quiet{};
  bool json{};
  bool force{};
  bool untrusted{};
};

/// Adds those of the flags `qjfu` that are named (quiet, json, force, untrusted).
void add_common_flags(CommandLine& line, CommonOptions& options, const std::string& which = "qj");

}  // namespace joulepath
