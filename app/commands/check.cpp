#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/terminal.hpp"
#include "model/printable.hpp"
#include "scenarios/any_file.hpp"

namespace joulepath {
namespace {

/// A text of several lines, safe for a terminal.
std::string printable_text(const std::string& text) {
  std::string lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines += printable(line) + "\n";
  return lines;
}

class Check : public Command {
 public:
  Check()
      : Command({.name = "check",
                 .says = "validate input files and report errors",
                 .examples = "  joulepath check scenarios/missions/warehouse_pick.yaml\n"
                             "  joulepath check robot.yaml dataset.yaml runs/run_01.csv\n"
                             "  joulepath check --kind robot my_robot.yaml"}) {}

  void declare(CommandLine& line) override {
    line.option("FILE", files_,
                "robot, map, mission, path, dataset, fleet, run log, bag, route graph, plan or diagnosis")
        .required();
    line.option("--kind", kind_, "kind of the files; default: from their schema line, name and keys");
    add_common_flags(line, options_, "qju");
  }

  int run() override {
    int code = kDone;
    auto results = nlohmann::ordered_json::array();
    for (const auto& file : files_) {
      try {
        const FileSummary summary = read_any_file(file, kind_, {options_.untrusted});
        results.push_back({{"file", file},
                           {"ok", true},
                           {"kind", summary.kind},
                           {"summary", summary.text},
                           {"notes", summary.notes}});
        if (!summary.proposal.empty()) results.back()["proposal"] = summary.proposal;
        if (!options_.json) tell(file, summary);
      } catch (const ConfigError& error) {
        code = kBadInput;
        const auto& d = error.detail();
        results.push_back({{"file", file},
                           {"ok", false},
                           {"error",
                            {{"file", d.mark.file},
                             {"line", d.mark.line},
                             {"column", d.mark.column},
                             {"key", d.key},
                             {"found", d.found},
                             {"accepted", d.accepted},
                             {"hint", d.hint},
                             {"message", error.what()}}}});
        if (!options_.json)
          std::cerr << paint(std::cerr, Paint::error, "joulepath: ") << printable(error.what()) << '\n';
      }
    }
    if (options_.json)
      std::cout << results.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
    return code;
  }

 private:
  void tell(const std::string& file, const FileSummary& summary) const {
    std::cout << printable(file) << ": " << paint(std::cout, Paint::good, "ok") << " (" << summary.kind
              << (summary.text.empty() ? "" : ": " + summary.text) << ")\n";
    if (!options_.quiet)
      for (const auto& note : summary.notes) std::cerr << "  note: " << printable(note) << '\n';
    if (!options_.quiet && !summary.proposal.empty()) std::cout << printable_text(summary.proposal);
  }

  std::vector<std::string> files_{};
  std::string kind_{};
  CommonOptions options_{};
};

}  // namespace

std::unique_ptr<Command> make_check_command() { return std::make_unique<Check>(); }

}  // namespace joulepath
