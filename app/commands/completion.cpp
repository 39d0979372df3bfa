#include <CLI/CLI.hpp>
#include <iostream>

#include "app/commands.hpp"

namespace joulepath {
namespace {

/// Completion scripts written from the commands themselves, so that they cannot go stale.
class Completion : public Command {
 public:
  std::string name() const override { return "completion"; }
  std::string says() const override { return "print a completion script for bash, zsh or fish"; }
  std::string examples() const override {
    return "  source <(joulepath completion bash)\n"
           "  joulepath completion zsh > \"${fpath[1]}/_joulepath\"\n"
           "  joulepath completion fish > ~/.config/fish/completions/joulepath.fish";
  }

  void declare(CLI::App& app) override {
    root_ = app.get_parent();
    app.add_option("SHELL", shell_)->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
  }

  int run() override {
    std::cout << (shell_ == "fish"  ? fish()
                  : shell_ == "zsh" ? "#compdef joulepath\nautoload -U bashcompinit\nbashcompinit\n" + bash()
                                    : bash());
    return kDone;
  }

 private:
  [[nodiscard]] std::vector<const CLI::App*> commands() const {
    return root_->get_subcommands([](const CLI::App*) { return true; });
  }

  static std::vector<std::string> flags_of(const CLI::App& app) {
    std::vector<std::string> flags;
    for (const auto* option : app.get_options())
      for (const auto& name : option->get_lnames()) flags.push_back("--" + name);
    return flags;
  }

  [[nodiscard]] std::string bash() const {
    std::string names, cases;
    for (const auto* command : commands()) {
      names += (names.empty() ? "" : " ") + command->get_name();
      std::string flags;
      for (const auto& flag : flags_of(*command)) flags += (flags.empty() ? "" : " ") + flag;
      cases += "    " + command->get_name() + ") words=\"" + flags + "\" ;;\n";
    }
    return "_joulepath() {\n"
           "  local current=${COMP_WORDS[COMP_CWORD]} words\n"
           "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
           "    COMPREPLY=($(compgen -W \"" +
           names +
           " --help --version\" -- \"$current\"))\n"
           "    return\n"
           "  fi\n"
           "  case ${COMP_WORDS[1]} in\n" +
           cases +
           "  esac\n"
           "  case $current in\n"
           "    -*) COMPREPLY=($(compgen -W \"$words\" -- \"$current\")) ;;\n"
           "    *) COMPREPLY=($(compgen -f -- \"$current\")) ;;\n"
           "  esac\n"
           "}\n"
           "complete -o filenames -F _joulepath joulepath\n";
  }

  [[nodiscard]] std::string fish() const {
    std::string text;
    for (const auto* command : commands()) {
      text += "complete -c joulepath -n __fish_use_subcommand -f -a " + command->get_name() + " -d '" +
              command->get_description() + "'\n";
      for (const auto& flag : flags_of(*command))
        text += "complete -c joulepath -n '__fish_seen_subcommand_from " + command->get_name() + "' -l " +
                flag.substr(2) + "\n";
    }
    return text;
  }

  const CLI::App* root_{};
  std::string shell_{};
};

}  // namespace

std::unique_ptr<Command> make_completion_command() { return std::make_unique<Completion>(); }

}  // namespace joulepath
