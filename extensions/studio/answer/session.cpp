#include "extensions/studio/answer/session.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "extensions/studio/answer/asked.hpp"
#include "extensions/studio/answer/drawn_plan.hpp"
#include "extensions/studio/answer/path_json.hpp"
#include "planner/baselines/comparison.hpp"
#include "planner/legs/floor_check.hpp"
#include "planner/mission/plan_front.hpp"
#include "planner/motion/motion_energy.hpp"
#include "scenarios/mission_files/plan_file.hpp"
// Design: docs/decisions/0702-studio-and-reports.md

namespace joulepath::studio {
namespace {

using nlohmann::json;
constexpr std::size_t kDraftNodes = 60, kSamples = 900, kFrontPoints = 20;
constexpr std::size_t kMostSamples = 20'000, kMostPoints = 200;

bool drives(const Plan& plan) {
  return plan.status == SolveStatus::optimal || plan.status == SolveStatus::feasible;
}

PlanOptions options_for(const json& question, const std::string& mode) {
  PlanOptions options{.solver = SolverChoice::fast, .baselines = false};
  options.draft = mode == "draft";
  const std::size_t nodes = question.value("nodes", options.draft ? kDraftNodes : options.nodes);
  options.nodes = std::clamp<std::size_t>(nodes, 10, 2000);
  return options;
}

json verdict_json(const std::optional<Infeasibility>& verdict) {
  if (!verdict) return nullptr;
  return {{"x_m", verdict->x_m},
          {"y_m", verdict->y_m},
          {"amount", verdict->amount},
          {"unit", verdict->unit},
          {"message", verdict->message}};
}

/// Path, start and collision of every leg.
json legs_json(const Plan& plan, const RouteSpace* space) {
  json legs = json::array();
  for (const LegPlan& leg : plan.legs) {
    const Path path = path_of(leg);
    std::optional<Infeasibility> blocked;
    if (space)
      blocked = leg.prescribed ? blocked_motion(*leg.prescribed, *space) : blocked_path(path, *space);
    const Pose& start = leg.start_pose;
    legs.push_back({{"path", leg.prescribed ? json(nullptr) : path_json(path)},
                    {"start", {start.x_m, start.y_m, start.heading_rad}},
                    {"blocked", verdict_json(blocked)}});
  }
  return legs;
}

json front_json(const Plan& plan, std::size_t points) {
  const FrontPoint rest = rest_of(plan);
  json list = json::array();
  for (const FrontPoint& driven : energy_time_front(planned_stretches(plan), points).points) {
    const FrontPoint point = sum_of(driven, rest);
    const double price_W = point.price_of_time_W;
    list.push_back({{"duration_s", point.duration_s},
                    {"energy_J", point.energy_J},
                    {"price_of_time_W", std::isfinite(price_W) ? json(price_W) : json(nullptr)}});
  }
  return list;
}

/// Joules by cause of a plan whose stretches got other profiles.
EnergyByCause energy_of(const Plan& driven, const Plant& plant) {
  EnergyByCause sum;
  for (const LegPlan& leg : driven.legs) {
    if (leg.prescribed) sum += leg.energy;
    for (const StretchPlan& stretch : leg.stretches)
      sum += energy_by_cause(path_motion(stretch.request), stretch.profile);
    sum.standby_J += plant.robot.power.standby_W * leg.dwell_s;
  }
  return sum;
}

/// Each classic profile driven in place of the plan's, with its motion where it can be driven.
json classics_json(const Plan& plan, const Plant& plant, std::size_t samples) {
  json list = json::array();
  for (const ComparedProfile& classic : compare_baselines(plan)) {
    json entry{{"name", classic.total.name}, {"feasible", classic.total.feasible}};
    if (classic.total.feasible) {
      entry["energy_J"] = classic.total.energy_J;
      entry["motion_energy_J"] = classic.total.motion_energy_J;
      entry["duration_s"] = classic.total.duration_s;
      entry["later_s"] = classic.total.later_s;
      entry["optimum_J"] = classic.total.optimum_J;
      Plan driven = plan;
      std::size_t next = 0;
      for (LegPlan& leg : driven.legs)
        for (StretchPlan& stretch : leg.stretches) stretch.profile = classic.profiles.at(next++);
      entry["energy_by_cause_J"] = json::parse(cause_json_text(energy_of(driven, plant)));
      entry["motion"] = drawn_motion(driven, plant, drawn_times_s(driven, samples));
    } else {
      entry["reason"] = classic.total.reason;
    }
    list.push_back(std::move(entry));
  }
  return list;
}

json error_json(const ConfigError& error) {
  const ConfigError::Detail& detail = error.detail();
  return {{"error",
           {{"message", error.what()},
            {"key", detail.key},
            {"found", detail.found},
            {"accepted", detail.accepted},
            {"hint", detail.hint}}}};
}

}  // namespace

Session::Session(MissionWorld floor, std::string folder)
    : floor_(std::move(floor)), folder_(std::move(folder)) {}
Session::~Session() = default;

std::shared_ptr<const RouteSpace> Session::space_for(const MissionRequest& mission,
                                                     const Robot& robot) const {
  if (!floor_.map) return nullptr;
  const json key{robot.footprint.radius_m, robot.footprint.polygon_m, mission.clearance_m};
  const std::scoped_lock guard(lock_);
  if (!space_ || space_key_ != key.dump()) {
    space_key_ = key.dump();
    space_ = std::make_shared<const RouteSpace>(*floor_.map, floor_.keepout ? &*floor_.keepout : nullptr,
                                                robot.footprint, mission.clearance_m);
  }
  return space_;
}

std::string Session::checked_answer(const json& question) const {
  const std::string mode = question.value("mode", "plan");
  Asked asked = asked_from(question, folder_);
  const Plant plant = make_plant(asked.robot);
  const std::shared_ptr<const RouteSpace> space = space_for(asked.mission, asked.robot);
  const bool searches = mode == "plan";
  if (!searches) follow_paths(asked.mission, question.value("paths", json()), plant);
  MissionWorld world{
      .robot = asked.robot, .speed_mask = floor_.speed_mask, .route_graph = floor_.route_graph};
  const Plan plan =
      plan_mission(asked.mission, world, options_for(question, mode), searches ? space.get() : nullptr);
  json answer{{"mode", mode}, {"limits", limit_names()}};
  if (drives(plan)) {
    const std::size_t samples = std::min(question.value("samples", kSamples), kMostSamples);
    answer["legs"] = legs_json(plan, space.get());
    answer["motion"] = drawn_motion(plan, plant, drawn_times_s(plan, samples));
    if (mode == "front")
      answer["front"] =
          front_json(plan, std::clamp<std::size_t>(question.value("points", kFrontPoints), 2, kMostPoints));
    if (mode == "bands") answer["bands"] = drawn_bands(plan, plant, drawn_times_s(plan, samples));
    if (mode == "classics") answer["classics"] = classics_json(plan, plant, samples);
  }
  return "{\"plan\":" + plan_json_text(plan) + "," + answer.dump().substr(1);
}

std::string Session::answer(const std::string& question) const try {
  return checked_answer(question_from<json>(question));
} catch (const ConfigError& error) {
  return error_json(error).dump(-1, ' ', false, json::error_handler_t::replace);
} catch (const std::exception& error) {  // no question may end a program that others ask, too
  return error_json(ConfigError({{}, "question", error.what(), "a question in the format of the page", ""}))
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace joulepath::studio
