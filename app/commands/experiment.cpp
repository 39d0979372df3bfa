#include <filesystem>
#include <iostream>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/terminal.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"

namespace joulepath {
namespace {

class Experiment : public Command {
 public:
  Experiment()
      : Command({.name = "experiment",
                 .says = "write the run that best separates the remaining candidates of a diagnosis",
                 .examples = "  joulepath experiment runs/dataset.yaml --out next_run.yaml\n"
                             "  joulepath simulate next_run.yaml --out out/next_run"}) {}

  void declare(CommandLine& line) override {
    line.option("dataset", dataset_, "dataset file (YAML)").required();
    line.option("--out", out_, "mission file to write").required();
    line.option("--robot", robot_, "robot file; replaces the dataset's");
    add_common_flags(line, common_, "qfu");
  }

  int run() override {
    const Dataset dataset = read_dataset(
        dataset_, {.untrusted = common_.untrusted, .cut_long_logs = true, .accept_implausible = true},
        robot_);
    const Diagnosis diagnosis = diagnose(dataset);
    if (diagnosis.next.motions.empty()) {
      const bool stale = common_.force && remove_output_file(out_);
      if (!common_.quiet)
        std::cout << "no candidates to separate: the verdict is " << verdict_name(diagnosis.verdict)
                  << (stale ? "; " + out_ + " of an earlier run is removed" : "") << '\n';
      return kDone;
    }
    const std::filesystem::path folder = std::filesystem::absolute(out_).parent_path();
    const std::string robot = robot_.empty() ? dataset.robot_file : robot_;
    write_output_file(
        out_,
        experiment_mission_text(
            diagnosis.next, std::filesystem::proximate(std::filesystem::absolute(robot), folder).string()),
        common_.force);
    if (!common_.quiet)
      std::cout << out_ << ": " << diagnosis.next.why << " (expected evidence "
                << diagnosis.next.expected_evidence << ", settles the question with a probability of "
                << figure(diagnosis.next.probability_settled, 2) << " by the model, not calibrated)\n";
    return kDone;
  }

 private:
  std::string dataset_{}, out_{}, robot_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_experiment_command() { return std::make_unique<Experiment>(); }

}  // namespace joulepath
