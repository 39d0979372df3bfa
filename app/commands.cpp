#include "app/commands.hpp"

#include "app/command_line.hpp"
#include "app/program_parts.hpp"

namespace joulepath {

std::vector<std::unique_ptr<Command>> all_commands() {
  std::vector<std::unique_ptr<Command>> commands;
#define JOULEPATH_MAKE(name) commands.push_back(make_##name##_command());
  JOULEPATH_COMMANDS(JOULEPATH_MAKE)
#undef JOULEPATH_MAKE
  for (const auto& [extension, make] : extension_parts().commands) {
    commands.push_back(make());
    commands.back()->belongs_to(extension);
  }
  return commands;
}

const ProgramParts& extension_parts() {
  static const ProgramParts all = [] {
    ProgramParts parts;
    add_extension_commands(parts);
    return parts;
  }();
  return all;
}

void add_common_flags(CommandLine& line, CommonOptions& options, const std::string& which) {
  const auto wants = [&](char flag) { return which.find(flag) != std::string::npos; };
  if (wants('f')) line.flag("--force", options.force, "overwrite existing results");
  if (wants('j')) line.flag("--json", options.json, "results as JSON on stdout");
  if (wants('q')) line.flag("-q,--quiet", options.quiet, "no progress and no summary");
  if (wants('u'))
    line.flag("--untrusted", options.untrusted, "refuse file names that lead outside the input's folder");
}

}  // namespace joulepath
