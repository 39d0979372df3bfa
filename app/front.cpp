#include "planner/front.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "app/command.hpp"
#include "app/commands.hpp"
#include "app/plan_options.hpp"
#include "app/report/report.hpp"
#include "app/study.hpp"
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
  std::string says() const override {
    return "the whole energy-time front of a mission or a path, with exact slopes";
  }
  std::string examples() const override {
    return "  joulepath front scenarios/missions/warehouse_pick.yaml --points 30\n"
           "  joulepath front mission.yaml --out out/front   # front.json and report.html\n"
           "  joulepath front path.csv --robot robot.yaml --payload 5\n";
  }

  void declare(CLI::App& app) override {
    add_study_options(app, study_, kResult, false);
    app.add_option("--points", points_, "points of the front; deadlines and durations are left aside")
        ->check(CLI::Range(2, 2000))
        ->capture_default_str();
    add_plan_options(app, study_.plan, "nodes on each stretch");
  }

  int run() override {
    OutputDirectory out = study_output(study_, kResult);
    const ReadOptions reading{.untrusted = study_.common.untrusted};
    MissionRequest mission = read_mission_source(study_.source, reading);
    const MissionWorld world = read_world(mission, reading);
    mission.objective = {};
    for (LegRequest& leg : mission.legs) {
      leg.deadline_s.reset();
      leg.duration_s.reset();
    }
    const Plan plan = plan_mission(mission, world, study_.plan);
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
    if (study_writes(study_)) write_study(out, kResult, result, report::front_report_html(result, {}, title));
    if (study_prints(study_, result)) table.print(std::cout);
  }

  static constexpr const char* kResult = "front.json";
  StudyOptions study_{};
  std::size_t points_{30};
};

}  // namespace

std::unique_ptr<Command> make_front_command() { return std::make_unique<FrontCommand>(); }

}  // namespace joulepath
