#include <iostream>

#include "app/command_line.hpp"
#include "app/program_parts.hpp"
#include "extensions/fleet/fleet_file.hpp"
#include "extensions/fleet/fleet_floor.hpp"
#include "model/printable.hpp"

namespace joulepath {
namespace {

/// The fleet planner is a part of the Python package; this command checks the file and says how to get it.
class FleetCommand : public Command {
 public:
  FleetCommand()
      : Command(
            {.name = "fleet",
             .says =
                 "check a fleet file; the Python package plans it: who drives what, when and where to charge",
             .examples = "  joulepath fleet scenarios/fleets/night_shift.yaml\n"
                         "  python -m joulepath fleet scenarios/fleets/night_shift.yaml --out out/night\n"}) {
  }
  void declare(CommandLine& line) override { line.option("FLEET", file_, "fleet file").required(); }
  int run() override {
    const Fleet fleet = read_fleet(file_);
    static_cast<void>(read_fleet_floor(fleet));
    for (const std::string& note : fleet_notes(fleet))
      std::cerr << "note: " << printable(file_ + ": " + note) << "\n";
    std::cerr << "joulepath: the fleet file is right; its planner is in the Python package: "
                 "pip install joulepath[fleet], then python -m joulepath fleet FLEET.yaml --out DIR\n";
    return kInfeasibleOrFailed;
  }

 private:
  std::string file_{};
};

std::unique_ptr<Command> make_fleet_command() { return std::make_unique<FleetCommand>(); }

}  // namespace

void add_fleet_commands(ProgramParts& parts) { parts.add(make_fleet_command); }

}  // namespace joulepath
