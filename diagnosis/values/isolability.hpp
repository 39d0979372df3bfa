#pragma once

#include <optional>
#include <string>
#include <vector>

namespace joulepath {

/// What the design of the runs (motions, payloads, channels, noise) lets a diagnosis see and tell apart,
/// whatever the cause of a gap may be. Effects have their typical sizes. Effects of a region of the floor are
/// left out: what they look like depends on where it lies.
struct Isolability {
  /// Value of an effect's strength.
  struct Strength {
    std::string parameter{};
    double value{};
  };
  struct Effect {
    std::string effect{};  ///< its label, side included
    double probability_seen{};
    std::optional<Strength> seen_from{};  ///< the least that nine in ten such datasets would show
    bool is_found{};                      ///< these runs show it, whatever its usual size
  };
  struct Pair {
    std::string effect{};
    std::string other{};
    double likelihood_ratio{};  ///< expected 2 ln LR of the true one against the other one's best fit
    double probability_told_apart{};
  };
  std::vector<Effect> effects{};  ///< in the catalog's order
  std::vector<Pair> pairs{};      ///< of the effects that would be seen
};

/// Effects that fewer than nine in ten such datasets would show, without those that were found.
[[nodiscard]] std::vector<std::string> unseen_effects(const Isolability& isolability);

/// The pairs that fewer than nine in ten such datasets would tell apart.
[[nodiscard]] std::vector<Isolability::Pair> inseparable_pairs(const Isolability& isolability);

/// Sets of effects that are inseparable each from each, the largest first; one effect may be in several.
[[nodiscard]] std::vector<std::vector<std::string>> inseparable_groups(const Isolability& isolability);

/// Two sentences at most: what the runs would not show, and what they could not tell apart.
[[nodiscard]] std::vector<std::string> isolability_notes(const Isolability& isolability);

}  // namespace joulepath
