#include <iostream>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "scenarios/text/filled.hpp"

namespace joulepath {

namespace embedded {
extern const std::string_view completion_bash;  // app/commands/completion.bash
}

namespace {

/// Completion scripts, generated from the commands so that they are always current.
class Completion : public Command {
 public:
  Completion()
      : Command({.name = "completion",
                 .says = "print a completion script for bash, zsh or fish",
                 .examples = "  source <(joulepath completion bash)\n"
                             "  joulepath completion zsh > \"${fpath[1]}/_joulepath\"\n"
                             "  joulepath completion fish > ~/.config/fish/completions/joulepath.fish"}) {}

  void declare(CommandLine& line) override {
    line.option("SHELL", shell_).required().one_of({"bash", "zsh", "fish"});
  }

  int run() override {
    print_whole_lines(std::cout, shell_ == "fish" ? fish()
                                 : shell_ == "zsh"
                                     ? "#compdef joulepath\nautoload -U bashcompinit\nbashcompinit\n" + bash()
                                     : bash());
    return kDone;
  }

 private:
  static std::string bash() {
    std::string names, cases;
    for (const CommandSummary& command : summaries(all_commands())) {
      names += (names.empty() ? "" : " ") + command.name;
      std::string flags;
      for (const auto& flag : command.flags) flags += (flags.empty() ? "" : " ") + flag;
      cases += "    " + command.name + ") words=\"" + flags + "\" ;;\n";
    }
    return filled(embedded::completion_bash, {{"@NAMES@", names}, {"@CASES@", cases}});
  }

  static std::string fish() {
    std::string text;
    for (const CommandSummary& command : summaries(all_commands())) {
      text += "complete -c joulepath -n __fish_use_subcommand -f -a " + command.name + " -d '" +
              command.says + "'\n";
      for (const auto& flag : command.flags)
        text += "complete -c joulepath -n '__fish_seen_subcommand_from " + command.name + "' -l " +
                flag.substr(2) + "\n";
    }
    return text;
  }

  std::string shell_{};
};

}  // namespace

std::unique_ptr<Command> make_completion_command() { return std::make_unique<Completion>(); }

}  // namespace joulepath
