#pragma once

#include "diagnosis/correction/validation.hpp"

namespace joulepath {

/// Runs may come out a little worse on energy while the correction is right.
inline constexpr double kToleratedWorsening = 1.05;
/// A held-out gap above so many noise floors is more than noise.
inline constexpr double kFloorsLeft = 2.0;

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
