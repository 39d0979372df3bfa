#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/plan_options.hpp"
#include "app/profile_columns.hpp"
#include "app/report/report.hpp"
#include "app/terminal.hpp"
#include "planner/baselines/comparison.hpp"
#include "planner/mission.hpp"
#include "planner/plan_accounts.hpp"
#include "scenarios/mission_file.hpp"

namespace joulepath {
namespace {

using nlohmann::json;

json profile_json(const BaselineTotal& total) {
  return {{"name", total.name},
          {"feasible", total.feasible},
          {"reason", total.reason},
          {"energy_J", total.energy_J},
          {"motion_energy_J", total.motion_energy_J},
          {"duration_s", total.duration_s},
          {"parameters", total.settings}};
}

BaselineTotal total_of(const Plan& plan) {
  return {.name = "plan",
          .energy_J = plan.energy.total_J(),
          .motion_energy_J = plan.energy.motion_J(),
          .duration_s = plan.duration_s};
}

void print_table(const Plan& plan, const std::vector<ComparedProfile>& compared) {
  Table table({"same path, same time", "total J", "plan saves", "motion J", "plan saves", ""});
  const auto row = [&](const BaselineTotal& total) {
    const bool counted = total.feasible;
    table.row(
        {total.name, counted ? figure(total.energy_J, 5) : "-",
         counted ? figure(saving_percent(plan.energy.total_J(), total.energy_J), 3) + " %" : "-",
         counted ? figure(total.motion_energy_J, 5) : "-",
         counted ? figure(saving_percent(plan.energy.motion_J(), total.motion_energy_J), 3) + " %" : "-",
         total.reason});
  };
  row(total_of(plan));
  table.rule();
  for (const ComparedProfile& profile : compared) row(profile.total);
  table.print(std::cout);
}

class CompareCommand : public Command {
 public:
  std::string name() const override { return "compare"; }
  std::string says() const override {
    return "a mission's plan against every classic profile, at equal distance and time";
  }
  std::string examples() const override {
    return "  joulepath compare scenarios/missions/warehouse_pick.yaml\n"
           "  joulepath compare mission.yaml --out out/compare   # compare.json and report.html\n";
  }

  void declare(CLI::App& app) override {
    app.add_option("mission", mission_, "mission file (YAML)")->required();
    app.add_option("--out", out_, "directory for compare.json and report.html");
    add_plan_options(app, options_);
    add_common_flags(app, common_, "qjfu");
  }

  int run() override {
    OutputDirectory out(
        out_.empty() ? "." : out_,
        out_.empty() ? std::vector<std::string>{} : std::vector<std::string>{"compare.json", "report.html"},
        common_.force);
    const ReadOptions reading{.untrusted = common_.untrusted};
    const MissionRequest mission = read_mission(mission_, reading);
    options_.solver = SolverChoice::fast;
    options_.baselines = false;  // nothing here reads the plan's own
    const Plan plan = plan_mission(mission, read_world(mission, reading), options_);
    if (plan.status != SolveStatus::optimal && plan.status != SolveStatus::feasible) {
      std::cerr << "no plan to compare with: " << solve_status_name(plan.status) << ": " << plan.message
                << "\n";
      return kInfeasibleOrFailed;
    }
    const std::vector<ComparedProfile> compared = compare_baselines(plan);
    json result = {{"schema", "joulepath/compare/1"}, {"mission", plan.mission}, {"profiles", json::array()}};
    result["profiles"].push_back(profile_json(total_of(plan)));
    for (const ComparedProfile& profile : compared) result["profiles"].push_back(profile_json(profile.total));
    if (!out_.empty()) {
      out.write("compare.json", result.dump(2) + "\n");
      out.write("report.html", report::compare_report_html(result, motions(plan, compared), plan.mission));
      out.commit();
    }
    if (common_.json)
      std::cout << result.dump(2) << "\n";
    else if (!common_.quiet)
      print_table(plan, compared);
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

  std::string mission_{};
  std::string out_{};
  PlanOptions options_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_compare_command() { return std::make_unique<CompareCommand>(); }

}  // namespace joulepath
