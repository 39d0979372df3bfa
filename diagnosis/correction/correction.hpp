#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// What a user takes over, and why there is nothing where there is nothing.
struct Correction {
  std::optional<Robot> robot{};  ///< constants moved, physical effects added
  std::vector<EffectSetting> instruments{};
  std::vector<std::string> notes{};
};

/// The robot as it seems to be, where one cause is told and the held-out energy does not get worse.
[[nodiscard]] Correction correction_of(const Examination& examination, const Validation& validation,
                                       const EnergyGap& gap);

}  // namespace joulepath
