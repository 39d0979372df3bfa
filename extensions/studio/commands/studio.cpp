#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/diagnose/diagnosis_results.hpp"
#include "app/output_directory.hpp"
#include "app/program_parts.hpp"
#include "extensions/studio/server/page.hpp"
#include "extensions/studio/server/server.hpp"
#include "scenarios/log_files/dataset_file.hpp"

namespace joulepath {
namespace {

class StudioCommand : public Command {
 public:
  StudioCommand()
      : Command(
            {.name = "studio",
             .says = "edit a mission in the browser and see energy, limits and time while dragging",
             .examples =
                 "  joulepath studio scenarios/missions/warehouse_pick.yaml\n"
                 "  joulepath studio mission.yaml --port 8017 --open\n"
                 "  joulepath studio mission.yaml --dataset runs/dataset.yaml\n"
                 "  joulepath studio mission.yaml --out studio.html   # one file that needs no program"}) {}

  void declare(CommandLine& line) override {
    line.option("mission", mission_, "mission (YAML)").required();
    line.option("--port", server_.port, "port on the loopback interface; 0: any free port")
        .between(0, 65535)
        .shows_default();
    line.flag("--open", open_, "open the page in the default browser");
    line.option("--out", out_,
                "write the page with the planned mission as one HTML file instead of serving it");
    line.option("--dataset", dataset_,
                "dataset to diagnose: the page then shows measured against predicted, too");
    line.option("--page", server_.page_folder,
                "source tree to take the page from, for work on the page itself");
    add_common_flags(line, common_, "qf");
  }

  int run() override {
    studio::MissionFiles files(
        mission_, [](const std::string& file, const std::string& content) { replace_file(file, content); });
    if (!dataset_.empty())
      server_.diagnosis =
          diagnosis_results(read_dataset(dataset_, {.cut_long_logs = true, .accept_implausible = true}), {})
              .json_with_signals();
    if (!out_.empty()) return write_page(files);
    studio::serve(files, server_, [this](const std::string& address) { tell(address); });
    return kDone;
  }

 private:
  int write_page(const studio::MissionFiles& files) const {
    const MissionWorld floor = files.read_floor();
    nlohmann::json question = nlohmann::json::parse(files.load().dump());
    const std::string answer = studio::Session(floor, files.folder()).answer(question.dump());
    write_output_file(
        out_, studio::page(studio::page_data(files, floor, answer, server_.diagnosis), server_.page_folder),
        common_.force);
    if (!studio::has_web_assembly() && !common_.quiet)
      std::cerr
          << "This program was built without WebAssembly: the page shows the plan and cannot change it.\n";
    if (!common_.quiet) std::cout << "written: " << out_ << "\n";
    return kDone;
  }

  void tell(const std::string& address) const {
    std::cout << address << std::endl;
    if (!common_.quiet) std::cerr << "The studio of " << mission_ << " is at this address until Ctrl-C.\n";
    if (open_ && std::system(("xdg-open '" + address + "' >/dev/null 2>&1 &").c_str()) != 0)
      std::cerr << "xdg-open did not start a browser\n";
  }

  std::string mission_{};
  std::string out_{}, dataset_{};
  bool open_{};
  studio::ServerOptions server_{};
  CommonOptions common_{};
};

std::unique_ptr<Command> make_studio_command() { return std::make_unique<StudioCommand>(); }

}  // namespace

void add_studio_commands(ProgramParts& parts) { parts.add(make_studio_command); }

}  // namespace joulepath
