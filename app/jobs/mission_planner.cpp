#include "app/jobs/mission_planner.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "app/build_id.hpp"
#include "app/jobs/content_hash.hpp"
#include "model/number_text.hpp"
#include "model/printable.hpp"
#include "planner/accounts/plan_accounts.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_check.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kUnreadable = "unreadable";  // instead of a digest

/// A batch result of a plan: the figures for reports and fleet managers.
Json plan_line(const Plan& plan) {
  Json json{{"status", solve_status_name(plan.status)}};
  if (plan.infeasibility) {
    json["constraint"] = plan.infeasibility->reason.constraint;
    json["leg"] = plan.infeasibility->leg;
    json["message"] = plan.infeasibility->reason.message;
    return json;
  }
  if (plan.status == SolveStatus::failed) {
    json["message"] = plan.message;
    return json;
  }
  json["energy_J"] = plan.energy.total_J();
  json["motion_energy_J"] = plan.energy.motion_J();
  json["duration_s"] = plan.duration_s;
  json["distance_m"] = plan.distance_m;
  json["optimality_gap_percent"] = plan.gap_percent;
  if (plan.path_bound && plan.path_bound->energy_J) {
    json["path_lower_bound_J"] = *plan.path_bound->energy_J;
    json["path_gap_percent"] = path_gap_percent(*plan.path_bound, plan.energy.total_J());
  } else if (plan.path_bound) {
    json["path_bound_reason"] = plan.path_bound->reason;
  }
  for (const BaselineTotal& baseline : plan.baselines)
    if (baseline.name == "trapezoid_best_tuned" && baseline.feasible)
      json["saving_percent"] = saving_percent(baseline.optimum_J, baseline.energy_J);
  if (plan.battery) json["battery_end_fraction"] = plan.battery->end_fraction;
  if (plan.confidence) {
    json["kept"] = plan.confidence->kept;
    for (const Promise& promise : plan.confidence->promises) json["promises"][promise.name] = promise.kept;
  }
  return json;
}

std::string text_of(const PlanOptions& o) {
  Json json{{"seed", o.seed},
            {"nodes", o.nodes},
            {"accuracy", o.accuracy},
            {"solver", static_cast<int>(o.solver)},
            {"steps", {o.steps.corners, o.steps.routes, o.steps.stops, o.steps.refinement}},
            {"baselines", o.baselines}};
  if (o.path_bound) json["path_bound"] = true;
  return json.dump();
}

}  // namespace

std::string MissionPlanner::content_digest(const std::string& file) {
  const std::lock_guard lock(digests_mutex_);
  const auto [digest, is_new] = digests_.emplace(file, kUnreadable);
  if (is_new) digest->second = ContentHash().mix(read_text_file(file)).text();
  if (digest->second == kUnreadable)
    throw ConfigError({{file, 0, 0}, "", "a file that could not be read", "a file that can be read"});
  return digest->second;
}

std::map<std::string, std::string> MissionPlanner::files_read() const {
  const std::lock_guard lock(digests_mutex_);
  return digests_;
}

std::map<std::string, std::string> MissionPlanner::options() const {
  std::map<std::string, std::string> given{{"--nodes", std::to_string(options_.nodes)},
                                           {"--seed", std::to_string(options_.seed)},
                                           {"--baselines", options_.baselines ? "yes" : "no"},
                                           {"--path-bound", options_.path_bound ? "yes" : "no"},
                                           {"--untrusted", reading_.untrusted ? "yes" : "no"}};
  if (confidence_) given["--confidence"] = number_text(*confidence_);
  return given;
}

std::string digest_of(const std::vector<MissionItem>& items) {
  ContentHash hash;
  for (const MissionItem& item : items) hash.mix(item.name).mix(item.text.empty() ? item.file : item.text);
  return hash.text();
}

std::string MissionPlanner::fingerprint(const MissionItem& item, const MissionVariant* variant) try {
  ContentHash hash;
  for (const std::string& part : {std::string(kBuildId), item.name, item.text, text_of(options_)})
    hash.mix(part);
  if (confidence_) hash.mix(number_text(*confidence_));
  const auto mix_file = [&](const std::string& file) { hash.mix(file + "=" + content_digest(file)); };
  if (item.text.empty()) mix_file(item.file);
  visit_files_read_by(mission_of(item, variant), reading_, mix_file);
  return hash.text();
} catch (const std::exception&) {
  return "";  // planning reports the reason
}

MissionRequest MissionPlanner::mission_of(const MissionItem& item, const MissionVariant* variant) const {
  const Document document = document_of(item);
  MissionRequest mission = variant != nullptr ? variant->mission(document) : mission_from(document, reading_);
  if (variant == nullptr && !item.text.empty() && !document.root().has("name")) mission.name = item.name;
  if (confidence_) mission.objective.confidence = confidence_;
  return mission;
}

const MissionPlanner::Place& MissionPlanner::place_of(const MissionRequest& mission) {
  ByteWriter key;
  key(mission.robot_file, mission.map_file, mission.keepout_file, mission.route_graph_file,
      mission.unknown_is_floor, mission.clearance_m, mission.speed_mask.has_value());
  if (mission.speed_mask) {
    const auto& [file, kind, base, multiplier] = *mission.speed_mask;
    key(file, kind, base, multiplier);
  }
  const std::lock_guard lock(mutex_);
  std::unique_ptr<Place>& place = places_[key.bytes()];
  if (!place) {
    auto made = std::make_unique<Place>();
    made->world = read_named_files(mission, reading_);
    if (has_footprint(made->world.robot)) made->space = route_space(mission, made->world);
    made->floor = floor_key(mission, made->world);
    place = std::move(made);
  }
  return *place;
}

/// A variant has its own robot; the floor is shared if the robot's outline is the same.
Plan MissionPlanner::plan_of(const MissionRequest& mission, const MissionVariant* variant) {
  const Place& place = place_of(mission);
  const RouteSpace* space = place.space ? &*place.space : nullptr;
  PlanOptions options = options_;
  const auto share = [&](const Robot& robot) {
    options.answers = {answers_.get(), world_key(place.floor, robot)};
  };
  if (variant == nullptr) {
    check_footprint(mission, place.world.robot);
    share(place.world.robot);
    return plan_mission(mission, place.world, options, space);
  }
  MissionWorld world = place.world;
  world.robot = variant->robot(mission.robot_file);
  check_footprint(mission, world.robot);
  share(world.robot);
  const Footprint &asked = world.robot.footprint, &known = place.world.robot.footprint;
  const bool same_outline = asked.radius_m == known.radius_m && asked.polygon_m == known.polygon_m;
  return plan_mission(mission, world, options, same_outline ? space : nullptr);
}

JobResult MissionPlanner::plan(const MissionItem& item, std::size_t index, Json json,
                               const MissionVariant* variant) {
  const auto start = std::chrono::steady_clock::now();
  try {
    const MissionRequest mission = mission_of(item, variant);
    if (variant == nullptr) json["name"] = mission.name;
    json.update(plan_line(plan_of(mission, variant)));
  } catch (const ConfigError& error) {
    json["status"] = "bad_input";
    json["message"] = printable(error.what());
  } catch (const std::bad_alloc&) {
    json["status"] = "environment_error";
    json["message"] = "not enough memory";
  } catch (const std::system_error& error) {
    json["status"] = "environment_error";
    json["message"] = printable(error.what());
  } catch (const std::exception& error) {
    json["status"] = "internal_error";
    json["message"] = printable(error.what());
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return {.index = index,
          .line = json.dump(-1, ' ', false, Json::error_handler_t::replace),
          .status = json["status"],
          .seconds = elapsed.count()};
}

JobResult MissionJobs::plan(std::size_t index) {
  return planner_.plan(items_[index], index, Json::parse(name_line(index)));
}

std::string MissionJobs::name_line(std::size_t index) const {
  return Json{{"index", index}, {"name", items_[index].name}}.dump(-1, ' ', false,
                                                                   Json::error_handler_t::replace);
}

}  // namespace joulepath
