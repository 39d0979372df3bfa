#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "model/effects/catalog.hpp"
#include "model/effects/effects_document.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

Json effect_json(const EffectDescription& effect) {
  Json parameters = Json::array();
  for (const ParameterDescription& p : effect.parameters)
    parameters.push_back({{"name", p.name},
                          {"unit", p.unit},
                          {"min", p.min},
                          {"max", p.max},
                          {"typical", p.typical},
                          {"meaning", p.meaning}});
  const EffectInfo& info = effect.info;
  return {{"name", info.name},
          {"kind", info.kind},
          {"stage", stage_name(info.stage)},
          {"law", info.law},
          {"validity", info.validity},
          {"source", info.source},
          {"gazebo", info.gazebo},
          {"mujoco", info.mujoco},
          {"has_side", effect.has_side},
          {"has_cells", effect.has_cells},
          {"parameters", parameters}};
}

class EffectsCommand : public Command {
 public:
  EffectsCommand()
      : Command({.name = "effects",
                 .says = "list the catalog of effects",
                 .examples = "  joulepath effects\n"
                             "  joulepath effects --json | jq -r '.effects[].name'\n"
                             "  joulepath effects --markdown > docs/effects.md\n"}) {}

  void declare(CommandLine& line) override {
    line.flag("--json", json_, "as JSON");
    line.flag("--markdown", markdown_, "as Markdown (docs/effects.md)");
  }

  int run() override {
    if (json_ && markdown_) throw UsageError("--json and --markdown exclude each other");
    if (markdown_)
      print_whole_lines(std::cout, effects_markdown());
    else if (json_)
      print_json();
    else
      print_table();
    return kDone;
  }

 private:
  static void print_json() {
    Json effects = Json::array();
    for (const EffectDescription& effect : effect_catalog()) effects.push_back(effect_json(effect));
    std::cout << Json{{"schema", "joulepath/effects/1"}, {"effects", effects}}.dump(2) << '\n';
  }

  static void print_table() {
    Table table({"effect", "stage", "parameter", "unit", "from", "to", "typical"});
    for (const EffectDescription& effect : effect_catalog()) {
      std::string name(effect.info.name);
      std::string stage(stage_name(effect.info.stage));
      const auto row = [&](const std::vector<std::string>& rest) {
        std::vector<std::string> cells{name, stage};
        cells.insert(cells.end(), rest.begin(), rest.end());
        table.row(cells);
        name = stage = "";
      };
      for (const ParameterDescription& p : effect.parameters)
        row({p.name, p.unit, figure(p.min), figure(p.max), figure(p.typical)});
      if (effect.has_side) row({"side", "", "left", "right", ""});
    }
    table.print(std::cout);
    std::cout << "laws, validity, counterparts in Gazebo and MuJoCo: docs/effects.md\n";
  }

  bool json_{};
  bool markdown_{};
};

}  // namespace

std::unique_ptr<Command> make_effects_command() { return std::make_unique<EffectsCommand>(); }

}  // namespace joulepath
