#include "model/effects/catalog.hpp"

#include <cmath>
#include <optional>
#include <sstream>

#include "model/config_error.hpp"

namespace joulepath {
namespace {

template <class Type>
EffectDescription describe() {
  EffectDescription description{.info = Type::info, .has_side = requires(Type e){e.side;
}
, .has_cells = requires(Type e) { e.cells; }
};  // namespace
for (const auto& p : Type::parameters())
  description.parameters.push_back({.name = std::string(p.name),
                                    .unit = std::string(p.unit),
                                    .min = p.min,
                                    .max = p.max,
                                    .typical = p.typical,
                                    .meaning = std::string(p.meaning)});
return description;
}  // namespace joulepath

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
      if (!setting.cells.empty() && p.name != Type::parameters().front().name)
        continue;  // cells replace edges
      refuse(setting, std::string(p.name), "nothing", range);
    }
    if (!(given->second >= p.min && given->second <= p.max))
      refuse(setting, std::string(p.name), text_of(given->second), range);
    effect.*(p.member) = given->second;
  }
  for (const auto& [name, value] : setting.parameters)
    if (!has_parameter<Type>(name)) {
      std::string known;
      for (const auto& p : Type::parameters()) known += (known.empty() ? "" : ", ") + std::string(p.name);
      refuse(setting, name, "a parameter that this effect does not have", known);
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
  ((Types::info.name == setting.name ? (effect = build<Types>(setting), true) : false) || ...);
  return effect;
}

}  // namespace

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
    std::string known;
    for (const EffectDescription& d : effect_catalog())
      known += (known.empty() ? "" : ", ") + std::string(d.info.name);
    throw ConfigError(
        {.mark = {}, .key = "effects", .found = "'" + setting.name + "'", .accepted = known, .hint = {}});
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
