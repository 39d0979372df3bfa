#pragma once

#include <string>
#include <utility>
#include <vector>

#include "machine.hpp"
#include "random.hpp"
#include "world.hpp"

namespace blind {

/// One effect of a label: a name of the catalog, or a foreign kind, with its parameters.
struct Effect {
  std::string name{};
  std::vector<std::pair<std::string, double>> parameters{};
  std::string side{};  ///< "", "left" or "right"
  bool foreign{false};
  double value(const std::string& parameter) const;
};

[[nodiscard]] const std::vector<std::string>& catalog_names();
[[nodiscard]] const std::vector<std::string>& foreign_names();

/// Draw an effect of that name: the size (its first parameter, in its own unit) log-uniform over the
/// machine's range, or as given by `size` or by `share` of a large effect (not 0); what else it needs at
/// random.
[[nodiscard]] Effect draw_effect(const std::string& name, const Machine& nominal, double size, double share,
                                 Random& random);

/// Put the effect into the true machine and world.
void apply_effect(const Effect& effect, const Machine& nominal, Machine& truth, World& world);

/// One YAML flow line `{effect: ..., parameter: value, ...}`.
[[nodiscard]] std::string effect_line(const Effect& effect);

}  // namespace blind
