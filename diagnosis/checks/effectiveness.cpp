#include "diagnosis/checks/effectiveness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0500-data-checks.md
namespace joulepath {

Effectiveness compare(const Relations& before, const Relations& after, bool by_factor) {
  Effectiveness result;
  double greatest = 0;
  bool harmed = false;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (!before[k] || !after[k] || (by_factor && before[k]->sound >= kSoundTorque)) continue;
    const double old_share = before[k]->unexplained + kExactRelation,
                 new_share = after[k]->unexplained + kExactRelation;
    const double nats = std::log(old_share / new_share);
    result.nats += nats;
    const bool broken = before[k]->unexplained > before[k]->sound;
    if (nats < -std::log(kRepairHarm) &&
        after[k]->unexplained > (by_factor ? after[k]->sound : after[k]->doubtful)) {
      harmed = true;
      if (!broken) result.contradicts = true;
    }
    const bool doubtful = before[k]->unexplained > before[k]->doubtful;
    const double least = broken     ? std::log(kRepairGain)
                         : doubtful ? std::log(kRepairGainOfDoubtful)
                                    : std::numeric_limits<double>::infinity();
    if (nats > std::max(greatest, least) && after[k]->unexplained <= after[k]->sound)
      greatest = nats, result.most = k;
  }
  result.repairs = greatest > 0 && !harmed;
  return result;
}

}  // namespace joulepath
