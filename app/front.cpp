#include "planner/front.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/plan_options.hpp"
#include "app/report/report.hpp"
#include "app/terminal.hpp"
#include "planner/mission.hpp"
#include "scenarios/mission_file.hpp"

namespace joulepath {
namespace {

using nlohmann::json;

json point_json(const FrontPoint& point) {
  json result = {{"duration_s", point.duration_s},
                 {"energy_J", point.energy_J},
                 {"motion_energy_J", point.motion_energy_J},
                 {"status", solve_status_name(point.status)}};
  result["price_of_time_W"] =
      std::isfinite(point.price_of_time_W) ? json(point.price_of_time_W) : json(nullptr);
  return result;
}

class FrontCommand : public Command {
 public:
  std::string name() const override { return "front"; }
  std::string says() const override { return "the whole energy-time front of a mission, with exact slopes"; }
  std::string examples() const override {
    return "  joulepath front scenarios/missions/warehouse_pick.yaml --points 30\n"
           "  joulepath front mission.yaml --out out/front   # front.json and report.html\n";
  }

  void declare(CLI::App& app) override {
    app.add_option("mission", mission_, "mission file (YAML); its deadlines and durations are left aside")
        ->required();
    app.add_option("--points", points_, "points of the front")
        ->check(CLI::Range(2, 2000))
        ->capture_default_str();
    app.add_option("--out", out_, "directory for front.json and report.html");
    add_plan_options(app, options_, "nodes on each stretch");
    add_common_flags(app, common_, "qjfu");
  }

  int run() override {
    OutputDirectory out(
        out_.empty() ? "." : out_,
        out_.empty() ? std::vector<std::string>{} : std::vector<std::string>{"front.json", "report.html"},
        common_.force);
    const ReadOptions reading{.untrusted = common_.untrusted};
    MissionRequest mission = read_mission(mission_, reading);
    const MissionWorld world = read_world(mission, reading);
    mission.objective = {};
    for (LegRequest& leg : mission.legs) {
      leg.deadline_s.reset();
      leg.duration_s.reset();
    }
    options_.solver = SolverChoice::fast;
    options_.baselines = false;  // nothing here reads the plan's own
    const Plan plan = plan_mission(mission, world, options_);
    std::vector<ProfileRequest> stretches;
    for (const LegPlan& leg : plan.legs)
      for (const StretchPlan& stretch : leg.stretches) stretches.push_back(stretch.request);
    const Front front = energy_time_front(stretches, points_);
    if (front.points.empty()) {
      const std::string& why = plan.message.empty() ? front.summary.message : plan.message;
      std::cerr << "no front: " << (why.empty() ? "the mission has no stretch to optimize" : why) << "\n";
      return kInfeasibleOrFailed;
    }
    show(front, rest_of(plan), plan.mission, out);
    return kDone;
  }

 private:
  /// Dwell and prescribed motions: the same at every point.
  static FrontPoint rest_of(const Plan& plan) {
    FrontPoint rest{.duration_s = plan.duration_s,
                    .energy_J = plan.energy.total_J(),
                    .motion_energy_J = plan.energy.motion_J()};
    for (const LegPlan& leg : plan.legs)
      for (const StretchPlan& stretch : leg.stretches) {
        rest.duration_s -= stretch.profile.duration_s();
        rest.energy_J -= stretch.energy.total_J();
        rest.motion_energy_J -= stretch.energy.motion_J();
      }
    return rest;
  }

  void show(const Front& front, const FrontPoint& rest, const std::string& title,
            OutputDirectory& out) const {
    json result = {{"schema", "joulepath/front/1"},
                   {"mission", title},
                   {"points", json::array()},
                   {"baselines", json::array()}};
    Table table({"duration s", "energy J", "without standby J", "price of a second W"});
    for (FrontPoint point : front.points) {
      point.duration_s += rest.duration_s;
      point.energy_J += rest.energy_J;
      point.motion_energy_J += rest.motion_energy_J;
      result["points"].push_back(point_json(point));
      table.row({figure(point.duration_s, 6), figure(point.energy_J, 6), figure(point.motion_energy_J, 6),
                 std::isfinite(point.price_of_time_W) ? figure(point.price_of_time_W, 4) : "-"});
    }
    if (!out_.empty()) {
      out.write("front.json", result.dump(2) + "\n");
      out.write("report.html", report::front_report_html(result, {}, title));
      out.commit();
    }
    if (common_.json)
      std::cout << result.dump(2) << "\n";
    else if (!common_.quiet)
      table.print(std::cout);
  }

  std::string mission_{};
  std::string out_{};
  std::size_t points_{30};
  PlanOptions options_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_front_command() { return std::make_unique<FrontCommand>(); }

}  // namespace joulepath
