#include "model/effects/catalog.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "model/config_error.hpp"
#include "model/text_of_list.hpp"
// Design: docs/decisions/0100-effects.md
namespace joulepath {
namespace {

/// Whether the first parameter, and no other, is a strength.
template <class Type>
constexpr bool strength_comes_first() {
  bool first = true;
  for (const auto& p : Type::parameters()) {
    const bool strength = p.role == ParameterRole::strength || p.role == ParameterRole::inverse_strength;
    if (strength != first) return false;
    first = false;
  }
  return !first;
}

template <class Type>
EffectDescription describe() {
  static_assert(strength_comes_first<Type>(), "say the role of every parameter after the first one");
  constexpr bool has_side = requires(Type e) { e.side; };
  constexpr bool has_cells = requires(Type e) { e.cells; };
  constexpr bool has_region = requires(Type e) { e.contains(0.0, 0.0); };
  constexpr bool delays_channels = requires(Type e) { e.channel_delay_s(); };
  EffectDescription description{.info = Type::info,
                                .has_side = has_side,
                                .has_cells = has_cells,
                                .has_region = has_region,
                                .delays_channels = delays_channels};
  if constexpr (requires(const Robot& robot) { Type::in_robot_file(robot); })
    description.in_robot_file = Type::in_robot_file;
  for (const auto& p : Type::parameters())
    description.parameters.push_back({.name = std::string(p.name),
                                      .unit = std::string(p.unit),
                                      .min = p.min,
                                      .max = p.max,
                                      .typical = p.typical,
                                      .meaning = std::string(p.meaning),
                                      .role = p.role,
                                      .yardstick = p.yardstick,
                                      .grid = {p.grid.begin(), p.grid.end()}});
  return description;
}

template <class... Types>
std::vector<EffectDescription> describe_all(const std::variant<Types...>*) {
  return {describe<Types>()...};
}

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

[[noreturn]] void refuse(const EffectSetting& setting, const std::string& parameter, const std::string& found,
                         const std::string& accepted) {
  throw ConfigError({.mark = {},
                     .key = "effects." + setting.name + (parameter.empty() ? "" : "." + parameter),
                     .found = found,
                     .accepted = accepted,
                     .hint = {}});
}

template <class Type>
bool has_parameter(const std::string& name) {
  for (const auto& p : Type::parameters())
    if (name == p.name) return true;
  return false;
}

template <class Type>
Effect build(const EffectSetting& setting) {
  Type effect{};
  for (const auto& p : Type::parameters()) {
    const auto given = setting.parameters.find(std::string(p.name));
    const std::string range = "a number from " + text_of(p.min) + " to " + text_of(p.max) +
                              (p.unit == "1" ? "" : " " + std::string(p.unit));
    if (given == setting.parameters.end()) {
      if (!setting.cells.empty() && p.role == ParameterRole::edge) continue;  // cells replace edges
      refuse(setting, std::string(p.name), "nothing", range);
    }
    if (!(given->second >= p.min && given->second <= p.max))
      refuse(setting, std::string(p.name), text_of(given->second), range);
    effect.*(p.member) = given->second;
  }
  for (const auto& [name, value] : setting.parameters)
    if (!has_parameter<Type>(name)) {
      refuse(setting, name, "a parameter that this effect does not have",
             text_of_list(Type::parameters(), [](const auto& p) { return p.name; }));
    }
  if constexpr (requires { effect.side; }) {
    if (!setting.side) refuse(setting, "side", "nothing", "left or right");
    effect.side = *setting.side;
  } else if (setting.side) {
    refuse(setting, "side", side_name(*setting.side), "no side: this effect acts on both");
  }
  if constexpr (requires { effect.cells; }) effect.cells = setting.cells;
  return effect;
}

template <class... Types>
std::optional<Effect> build_any(const EffectSetting& setting, const std::variant<Types...>*) {
  std::optional<Effect> effect;
  static_cast<void>(
      ((Types::info.name == setting.name ? (effect = build<Types>(setting), true) : false) || ...));
  return effect;
}

}  // namespace

double typical_size(const ParameterDescription& parameter, const Robot& robot) {
  const Yardstick& yardstick = parameter.yardstick;
  const double measure = yardstick.of ? yardstick.of(robot) : 0.0;
  return measure > 0 ? parameter.typical * measure / yardstick.reference : parameter.typical;
}

std::vector<double> search_grid(const ParameterDescription& parameter, const Robot& robot) {
  const double typical = typical_size(parameter, robot), scale = typical / parameter.typical;
  std::vector<double> grid = parameter.grid;
  for (double& value : grid) value *= scale;
  if (grid.empty())
    for (double factor : {0.3, 1.0, 3.0}) grid.push_back(factor * typical);
  for (double& value : grid) value = std::clamp(value, parameter.min, parameter.max);
  return grid;
}

const ParameterDescription* EffectDescription::find(ParameterRole role) const {
  for (const ParameterDescription& parameter : parameters)
    if (parameter.role == role) return &parameter;
  return nullptr;
}

const ParameterDescription* EffectDescription::find(const std::string& name) const {
  for (const ParameterDescription& parameter : parameters)
    if (parameter.name == name) return &parameter;
  return nullptr;
}

const std::vector<EffectDescription>& effect_catalog() {
  static const std::vector<EffectDescription> catalog = describe_all(static_cast<const Effect*>(nullptr));
  return catalog;
}

const EffectDescription* find_effect(const std::string& name) {
  for (const EffectDescription& description : effect_catalog())
    if (description.info.name == name) return &description;
  return nullptr;
}

Effect make_effect(const EffectSetting& setting) {
  std::optional<Effect> effect = build_any(setting, static_cast<const Effect*>(nullptr));
  if (!effect) {
    throw ConfigError(
        {.mark = {},
         .key = "effects",
         .found = "'" + setting.name + "'",
         .accepted = text_of_list(effect_catalog(), [](const EffectDescription& d) { return d.info.name; }),
         .hint = {}});
  }
  return *effect;
}

EffectSetting setting_of(const Effect& effect) {
  return std::visit(
      [](const auto& e) {
        EffectSetting setting{.name = std::string(e.info.name)};
        for (const auto& p : e.parameters()) setting.parameters[std::string(p.name)] = e.*(p.member);
        if constexpr (requires { e.side; }) setting.side = e.side;
        if constexpr (requires { e.cells; }) setting.cells = e.cells;
        return setting;
      },
      effect);
}

}  // namespace joulepath
