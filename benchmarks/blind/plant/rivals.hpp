#pragma once

#include <string>
#include <vector>

#include "signals.hpp"

namespace blind {

/// An effect of the catalog that another one may be mistaken for, with free amplitudes.
struct Rival {
  Effect effect{};                ///< with its further parameters; the first one follows from the amplitudes
  Vector step{};                  ///< of each amplitude, for its derivative: a middle size of the range
  Vector least{}, most{};         ///< of each amplitude: sign, and twice the strongest of the range
  bool bends{};                   ///< its law has a form that may differ from the textbook's
  std::vector<std::size_t> at{};  ///< columns of its amplitudes; its bends follow all amplitudes
};

/// All effects of the catalog but this one. Sides are rivals of their own, and so are a few values of what
/// else shapes a law: the place of a floor patch, the speed of Stribeck's curve, the caster's trail, the
/// winding's time constant.
[[nodiscard]] std::vector<Rival> rivals_of(const Case& c, const std::string& truth);

/// Put a rival of these amplitudes into the scene.
void put_rival(const Case& c, const Rival& rival, const Vector& amplitudes, Scene& scene);

}  // namespace blind
