#include "extensions/nav2/exports.hpp"
#include "extensions/nav2/leg_settings.hpp"
#include "scenarios/export/loss_json.hpp"
#include "scenarios/result_files/output_schemas.hpp"

namespace joulepath {
namespace {

Schema settings_schema() {
  return open(map({required("leg", integer(kNotNegative), "counted from 0"), required("to", text()),
                   optional("speed_m_s", number(kPositive)), optional("acceleration_m_s2", number(kPositive)),
                   optional("deceleration_m_s2", number(kPositive)),
                   optional("yaw_rate_rad_s", number(kPositive), "of turns in place"),
                   optional("yaw_acceleration_rad_s2", number(kPositive)),
                   optional("yaw_deceleration_rad_s2", number(kPositive))}));
}

using Json = nlohmann::ordered_json;

Json leg_json(const LegSettings& settings, const LegPlan& leg, std::size_t index) {
  Json json{{"leg", index}, {"to", leg.to}};
  if (settings.drive) {
    json["speed_m_s"] = settings.drive->rate;
    json["acceleration_m_s2"] = settings.drive->acceleration;
    json["deceleration_m_s2"] = settings.drive->deceleration;
  }
  if (settings.turn) {
    json["yaw_rate_rad_s"] = settings.turn->rate;
    json["yaw_acceleration_rad_s2"] = settings.turn->acceleration;
    json["yaw_deceleration_rad_s2"] = settings.turn->deceleration;
  }
  return json;
}

}  // namespace

Schema controller_schema() {
  return open(
      map({optional("schema", text(), "joulepath/controller/1"), optional("mission", text()),
           required("legs", list(settings_schema())), required("loss", result_schema("loss_of_settings"))}));
}

Export export_controller(const ExportInput& input) {
  const std::vector<LegSettings> settings = leg_settings(input.plan);
  const ControllerLoss loss = loss_of(input.plan, drive_with(input.plan, settings));
  Json json{{"schema", "joulepath/controller/1"}, {"mission", input.plan.mission}, {"legs", Json::array()}};
  for (std::size_t k = 0; k < settings.size(); ++k)
    json["legs"].push_back(leg_json(settings[k], input.plan.legs[k], k));
  json["loss"] = loss_json(loss);
  return {.files = {{input.out_file, json.dump(1) + "\n"}}, .loss = loss};
}

}  // namespace joulepath
