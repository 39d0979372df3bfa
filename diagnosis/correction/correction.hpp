#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// What a user takes over, and why there is nothing where there is nothing.
struct Correction {
  std::optional<Robot> robot{};  ///< constants moved, physical effects added
  std::vector<EffectSetting> instruments{};
  std::vector<std::string> notes{};
};

/// The corrected robot, if the cause is unambiguous and the held-out energy gap does not grow.
[[nodiscard]] Correction correction_of(const Examination& examination, const Validation& validation,
                                       const EnergyGap& gap);

}  // namespace joulepath
