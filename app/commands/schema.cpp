#include <iostream>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "scenarios/file_kinds.hpp"

namespace joulepath {
namespace {

class SchemaCommand : public Command {
 public:
  SchemaCommand()
      : Command({.name = "schema",
                 .says = "print the JSON Schema of a kind of file",
                 .examples = "  joulepath schema                           list the kinds\n"
                             "  joulepath schema robot > robot.schema.json\n"
                             "  # in an editor with the YAML language server, as first line of a file:\n"
                             "  # yaml-language-server: $schema=robot.schema.json"}) {}

  void declare(CommandLine& line) override {
    line.option("KIND", kind_, "kind of file; without it: list the kinds");
  }

  int run() override {
    if (kind_.empty()) {
      std::size_t width = 0;
      for (const auto& kind : file_kinds()) width = std::max(width, kind.name.size());
      for (const auto& kind : file_kinds())
        std::cout << kind.name << std::string(width + 2 - kind.name.size(), ' ') << kind.says << '\n';
      return kDone;
    }
    std::vector<std::string> names;
    for (const auto& kind : file_kinds()) {
      names.push_back(kind.name);
      if (kind.name != kind_) continue;
      print_whole_lines(std::cout, json_schema(kind));
      return kDone;
    }
    const std::string near = nearest_word(kind_, names);
    throw UsageError("no kind of file '" + kind_ + "'" +
                     (near.empty() ? "" : "; did you mean " + near + "?"));
  }

 private:
  std::string kind_{};
};

}  // namespace

std::unique_ptr<Command> make_schema_command() { return std::make_unique<SchemaCommand>(); }

}  // namespace joulepath
