#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/plan/loss_table.hpp"
#include "app/plan/plan_comparison.hpp"
#include "app/plan/profile_columns.hpp"
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
    line.option("--plugin", plugin_, "with --controller: the plugin that drives, where the file has several");
  }

  [[nodiscard]] bool is_asked() const override { return !controller_.empty(); }

  int run(const Plan& plan, const report::MissionExtras& extras, const AnalysisOptions& options,
          OutputDirectory& out, const std::string& result_file) override {
    const ControllerFile settings = read_controller_settings(controller_, plugin_);
    const ControlledDrive drive = drive_with(plan, settings);
    const ControllerLoss loss = loss_of(plan, drive);
    nlohmann::json result{{"schema", "joulepath/loss/1"},
                          {"of", controller_},
                          {"mission", plan.mission},
                          {"plan", {{"duration_s", plan.duration_s}, {"energy_J", plan.energy.total_J()}}},
                          {"parameters", settings.read},
                          {"unused", settings.unused},
                          {"not_modelled", settings.not_modelled}};
    result.update(loss_json(loss));
    if (writes_analysis(options))
      write_analysis(out, result_file, result,
                     report::compare_report_html({{"loss", result}}, motions(plan, drive), extras));
    if (prints_analysis_table(options, result)) {
      print_reading(settings);
      print_loss(std::cout, plan, loss);
      print_analysis_place(options);
    }
    return kDone;
  }

 private:
  /// The plan and the drive with the settings, for plots; none where the settings cannot drive a stretch.
  static std::vector<report::NamedColumns> motions(const Plan& plan, const ControlledDrive& drive) {
    constexpr int kMostSamples = 300, kLeastOfStretch = 12;
    std::vector<const ProfileRequest*> requests;
    std::vector<Profile> planned;
    for_each_stretch(plan, [&](const StretchPlace&, const StretchPlan& stretch) {
      requests.push_back(&stretch.request);
      planned.push_back(stretch.profile);
    });
    if (std::ranges::any_of(drive.profiles, [](const Profile& one) { return one.time_s.empty(); })) return {};
    const int count = std::max(1, static_cast<int>(requests.size()));
    const int samples = std::max(kLeastOfStretch, kMostSamples / count - 1);
    return {{"plan", profile_columns(requests, planned, samples)},
            {"settings", profile_columns(requests, drive.profiles, samples)}};
  }

  static void print_reading(const ControllerFile& settings) {
    const auto line = [](const char* what, const std::vector<std::string>& of) {
      for (const std::string& one : of) std::cout << what << one << '\n';
    };
    std::vector<std::string> read;
    for (std::size_t k = 0; k < settings.read.size(); ++k)
      read.push_back(settings.read[k] + " in line " + std::to_string(settings.lines[k]));
    line("read: ", read);
    line("not used: ", settings.unused);
    line("not modelled: ", settings.not_modelled);
  }

  std::string controller_{}, plugin_{};
};

}  // namespace

std::unique_ptr<PlanComparison> make_settings_comparison() { return std::make_unique<SettingsComparison>(); }

}  // namespace joulepath
