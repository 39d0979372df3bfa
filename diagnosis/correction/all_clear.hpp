#pragma once

#include <string>
#include <vector>

#include "diagnosis/correction/validation.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The verdict after a check of the runs' statistical power: `no_gap` and `explained` need runs that could
/// have shown a gap.
struct AllClear {
  Verdict verdict{};
  /// Gap (% of the energy) caused by an effect of the catalog that is detected in 90 % of such datasets. 0
  /// where the verdict does not need it.
  double detectable_percent{};
  std::vector<HardToSee> hard_to_see{};
  std::string note{};
};

/// Whether the model as it is written misses the measured energy by more than noise and by a share that
/// matters. Constants within their uncertainty may cover such a gap.
[[nodiscard]] bool is_seen(const EnergyGap& measured);

/// `listed`: effects that the runs show, too small to count.
[[nodiscard]] AllClear examine_all_clear(const Examination& x, Verdict verdict, const EnergyGap& measured,
                                         const std::vector<SmallEffect>& listed = {});

}  // namespace joulepath
