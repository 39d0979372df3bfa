#include "app/commands.hpp"

#include <CLI/CLI.hpp>

namespace joulepath {

std::vector<std::unique_ptr<Command>> all_commands() {
  std::vector<std::unique_ptr<Command>> commands;
#define JOULEPATH_MAKE(name) commands.push_back(make_##name##_command());
  JOULEPATH_COMMANDS(JOULEPATH_MAKE)
#undef JOULEPATH_MAKE
  return commands;
}

void add_common_flags(CLI::App& app, CommonOptions& options, const std::string& which) {
  const auto wants = [&](char flag) { return which.find(flag) != std::string::npos; };
  if (wants('f')) app.add_flag("--force", options.force, "overwrite existing results");
  if (wants('j')) app.add_flag("--json", options.json, "results as JSON on stdout");
  if (wants('q')) app.add_flag("-q,--quiet", options.quiet, "no progress and no summary");
  if (wants('u'))
    app.add_flag("--untrusted", options.untrusted,
                 "names inside of the input may not leave the input's folder");
}

}  // namespace joulepath
