#include "scenarios/robot_files/effect_list.hpp"

#include "model/effects/catalog.hpp"

namespace joulepath {
namespace {

constexpr const char* kProbability = "probability";

Schema effect_schema(const EffectDescription& effect) {
  std::vector<Schema::Key> keys;
  for (const auto& p : effect.parameters) {
    const bool replaced_by_cells = effect.has_cells && p.role == ParameterRole::edge;
    const std::string says = p.meaning + (p.unit == "1" ? "" : ", in " + p.unit);
    keys.push_back({p.name, number({p.min, p.max}), says, !replaced_by_cells});
  }
  if (effect.has_side)
    keys.push_back(required("side", choice({"left", "right"}), "as seen when driving forward"));
  if (effect.has_cells)
    keys.push_back(optional("cells", list(list(number(), 4, 4), 1),
                            "instead of the rectangle: [x_min_m, x_max_m, y_min_m, y_max_m] of each cell"));
  keys.push_back(optional(kProbability, number({0, 1}),
                          "that the robot has this effect, for plans with a stated confidence; default 1"));
  return map(std::move(keys));
}

std::vector<std::array<double, 4>> read_cells(const Node& node) {
  std::vector<std::array<double, 4>> cells;
  for (const auto& item : node.items()) {
    const auto edges = item.items();
    cells.push_back({edges[0].number(), edges[1].number(), edges[2].number(), edges[3].number()});
    if (cells.back()[0] >= cells.back()[1] || cells.back()[2] >= cells.back()[3])
      item.fail_found("a cell with no area", "[x_min_m, x_max_m, y_min_m, y_max_m] with min < max");
  }
  return cells;
}

EffectSetting read_effect(const std::string& name, const Node& node) {
  EffectSetting setting{.name = name};
  for (const auto& [key, value] : node.entries()) {
    if (key == "side")
      setting.side = value.text() == "left" ? Side::left : Side::right;
    else if (key == "cells")
      setting.cells = read_cells(value);
    else if (key == kProbability)
      setting.probability = value.number();
    else
      setting.parameters[key] = value.number();
  }
  try {
    static_cast<void>(make_effect(setting));
  } catch (const ConfigError& error) {
    ConfigError::Detail detail = error.detail();
    detail.mark = node.mark();
    const std::string prefix = "effects." + name;
    detail.key = node.path() + (detail.key.rfind(prefix, 0) == 0 ? detail.key.substr(prefix.size()) : "");
    throw ConfigError(detail);
  }
  return setting;
}

}  // namespace

Schema effect_entry_schema() {
  std::vector<Schema::Key> names;
  for (const auto& effect : effect_catalog())
    names.push_back(
        optional(std::string(effect.info.name), effect_schema(effect), std::string(effect.info.law)));
  Schema entry = map(std::move(names));
  entry.min_items = entry.max_items = 1;
  return entry;
}

EffectSetting read_effect_entry(const Node& entry) {
  const auto [name, parameters] = entry.entries().front();
  return read_effect(name, parameters);
}

Schema effect_list_schema() { return list(effect_entry_schema()); }

std::vector<EffectSetting> read_effect_list(const Node& node) {
  std::vector<EffectSetting> settings;
  for (const auto& item : node.items()) settings.push_back(read_effect_entry(item));
  return settings;
}

}  // namespace joulepath
