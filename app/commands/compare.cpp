#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/plan/plan_analysis.hpp"
#include "app/plan/plan_options.hpp"
#include "app/plan/plan_summary.hpp"
#include "app/plan/profile_columns.hpp"
#include "app/program_parts.hpp"
#include "app/report/plan_report.hpp"
#include "app/terminal.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "planner/baselines/comparison.hpp"
#include "planner/mission/mission.hpp"
#include "scenarios/mission_files/mission_file.hpp"

namespace joulepath {
namespace {

using PlanComparisons = std::vector<std::unique_ptr<PlanComparison>>;

nlohmann::json profile_json(const BaselineTotal& total) {
  nlohmann::json profile = baseline_json(total);
  profile["parameters"] = total.settings;
  return profile;
}

BaselineTotal total_of(const Plan& plan) {
  return {.name = "plan",
          .energy_J = plan.energy.total_J(),
          .motion_energy_J = plan.energy.motion_J(),
          .duration_s = plan.duration_s,
          .optimum_J = plan.energy.total_J(),
          .optimum_motion_J = plan.energy.motion_J()};
}

void print_table(const Plan& plan, const std::vector<ComparedProfile>& compared) {
  Table table(baseline_header());
  table.row(baseline_cells(total_of(plan)));
  table.rule();
  for (const ComparedProfile& profile : compared) table.row(baseline_cells(profile.total));
  table.print(std::cout);
  for (const ComparedProfile& profile : compared) print_baseline_reason(std::cout, profile.total);
}

std::string compare_examples(const PlanComparisons& comparisons) {
  std::string text =
      "  joulepath compare scenarios/missions/warehouse_pick.yaml\n"
      "  joulepath compare mission.yaml --out out/compare   # compare.json and report.html\n"
      "  joulepath compare path.csv --robot robot.yaml --payload 5 --time 30\n";
  for (const auto& comparison : comparisons) text += example_line("compare", comparison->example());
  return text;
}

class CompareCommand : public Command {
 public:
  explicit CompareCommand(PlanComparisons comparisons)
      : Command({.name = "compare",
                 .says = "compare a plan with every classic profile on the same path, each in its own time",
                 .examples = compare_examples(comparisons)}),
        comparisons_(std::move(comparisons)) {}

  void declare(CommandLine& line) override {
    add_analysis_options(line, options_, kResult);
    for (const auto& comparison : comparisons_) comparison->declare(line);
    add_plan_options(line, options_.plan);
  }

  int run() override {
    OutputDirectory out = analysis_output(options_, kResult);
    const ReadOptions reading{.untrusted = options_.common.untrusted};
    const MissionRequest mission = read_told_source(options_.source, reading, options_.common.quiet);
    const MissionWorld world = read_told_world(mission, reading, options_.common.quiet);
    const Plan plan = plan_mission(mission, world, options_.plan);
    if (plan.status != SolveStatus::optimal && plan.status != SolveStatus::feasible) {
      std::cerr << "no plan to compare with: " << solve_status_name(plan.status) << ": " << plan.message
                << "\n";
      return kInfeasibleOrFailed;
    }
    const auto extras =
        writes_analysis(options_) ? report::mission_extras(plan, mission, world) : report::MissionExtras{};
    for (const auto& comparison : comparisons_)
      if (comparison->is_asked()) return comparison->run(plan, extras, options_, out, kResult);
    const std::vector<ComparedProfile> compared = compare_baselines(plan);
    nlohmann::json result = {
        {"schema", "joulepath/compare/1"}, {"mission", plan.mission}, {"profiles", nlohmann::json::array()}};
    result["profiles"].push_back(profile_json(total_of(plan)));
    for (const ComparedProfile& profile : compared) result["profiles"].push_back(profile_json(profile.total));
    if (writes_analysis(options_))
      write_analysis(out, kResult, result,
                     report::compare_report_html(result, motions(plan, compared), extras));
    if (prints_analysis_table(options_, result)) {
      print_table(plan, compared);
      print_analysis_place(options_);
    }
    return kDone;
  }

 private:
  static std::vector<report::NamedColumns> motions(const Plan& plan,
                                                   const std::vector<ComparedProfile>& compared) {
    std::vector<const ProfileRequest*> requests;
    std::vector<Profile> own;
    for (const LegPlan& leg : plan.legs)
      for (const StretchPlan& stretch : leg.stretches) {
        requests.push_back(&stretch.request);
        own.push_back(stretch.profile);
      }
    std::vector<report::NamedColumns> columns{{"plan", profile_columns(requests, own)}};
    for (const ComparedProfile& profile : compared)
      if (profile.total.feasible && profile.profiles.size() == requests.size())
        columns.push_back({profile.total.name, profile_columns(requests, profile.profiles)});
    return columns;
  }

  static constexpr const char* kResult = "compare.json";
  AnalysisOptions options_{};
  PlanComparisons comparisons_;
};

}  // namespace

std::unique_ptr<Command> make_compare_command() {
  return std::make_unique<CompareCommand>(made(extension_parts().comparisons));
}

}  // namespace joulepath
