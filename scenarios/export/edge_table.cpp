#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "planner/accounts/edge_energy.hpp"
#include "scenarios/export/exports.hpp"

namespace joulepath {
namespace {

using Json = nlohmann::ordered_json;

/// Values that are zero by physics are written as zero, without rounding noise.
double joules(double value_J) { return std::abs(value_J) < 1e-9 ? 0.0 : value_J; }

Json row_json(const EdgeEnergy& edge, const Plan& plan) {
  double effects_J = 0;
  for (const auto& [name, energy_J] : edge.energy.effects_J) effects_J += energy_J;
  return {{"leg", edge.leg},
          {"to", plan.legs[edge.leg].to},
          {"edge", edge.name},
          {"kind", edge_kind_name(edge.kind)},
          {"start_s", edge.start_s},
          {"duration_s", edge.duration_s},
          {"distance_m", edge.distance_m},
          {"turned_rad", edge.turned_rad},
          {"payload_kg", edge.payload_kg},
          {"from_x_m", edge.from.x_m},
          {"from_y_m", edge.from.y_m},
          {"to_x_m", edge.to.x_m},
          {"to_y_m", edge.to.y_m},
          {"energy_J", edge.energy.total_J()},
          {"motion_energy_J", edge.energy.motion_J()},
          {"copper_J", joules(edge.energy.copper_J)},
          {"coulomb_friction_J", joules(edge.energy.coulomb_friction_J)},
          {"viscous_friction_J", joules(edge.energy.viscous_friction_J)},
          {"kinetic_J", joules(edge.energy.kinetic_J)},
          {"effects_J", joules(effects_J)},
          {"not_recovered_J", joules(edge.energy.not_recovered_J)},
          {"standby_J", joules(edge.energy.standby_J)}};
}

/// A table of objects with the same keys as CSV; texts are quoted.
std::string csv_text(const Json& rows) {
  std::string text;
  for (const auto& [key, value] : rows.front().items()) text += (text.empty() ? "" : ",") + key;
  text += '\n';
  for (const Json& row : rows) {
    std::string line;
    for (const auto& [key, value] : row.items()) line += (line.empty() ? "" : ",") + value.dump();
    text += line + '\n';
  }
  return text;
}

}  // namespace

Export export_edges(const ExportInput& input) {
  Json rows = Json::array();
  for (const EdgeEnergy& edge : edge_energies(input.plan, input.plant))
    rows.push_back(row_json(edge, input.plan));
  if (std::filesystem::path(input.out_file).extension() != ".json")
    return {.files = {{input.out_file, rows.empty() ? std::string() : csv_text(rows)}}};
  const Json json{{"schema", "joulepath/edges/1"},
                  {"mission", input.plan.mission},
                  {"energy_J", input.plan.energy.total_J()},
                  {"duration_s", input.plan.duration_s},
                  {"edges", std::move(rows)}};
  return {.files = {{input.out_file, json.dump(1) + "\n"}}};
}

}  // namespace joulepath
