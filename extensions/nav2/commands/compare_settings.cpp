#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/plan/loss_table.hpp"
#include "extensions/nav2/commands/nav2_commands.hpp"
#include "extensions/nav2/controller_settings.hpp"
#include "scenarios/export/loss_json.hpp"

namespace joulepath {
namespace {

/// What the settings of a file cost on the plan's path; no classic profiles.
class SettingsComparison : public PlanComparison {
 public:
  [[nodiscard]] std::string example() const override { return "mission.yaml --controller nav2_params.yaml"; }

  void declare(CommandLine& line) override {
    line.option(
        "--controller", controller_,
        "parameter file of Nav2 or ros2_control (YAML): compares the energy of its speeds and accelerations");
  }

  [[nodiscard]] bool is_asked() const override { return !controller_.empty(); }

  int run(const Plan& plan, const AnalysisOptions& options, OutputDirectory& out,
          const std::string& result_file) override {
    const ControllerFile settings = read_controller_settings(controller_);
    const ControllerLoss loss = loss_of(plan, drive_with(plan, settings));
    nlohmann::json result{{"schema", "joulepath/loss/1"}, {"of", controller_}, {"parameters", settings.read}};
    result.update(loss_json(loss));
    if (writes_analysis(options)) {
      out.write(result_file, result.dump(1) + "\n");
      out.commit();
    }
    if (prints_analysis_table(options, result)) print_loss(std::cout, plan, loss);
    return kDone;
  }

 private:
  std::string controller_{};
};

}  // namespace

std::unique_ptr<PlanComparison> make_settings_comparison() { return std::make_unique<SettingsComparison>(); }

}  // namespace joulepath
