#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnosis/checks/relations.hpp"

namespace joulepath {

/// What one run's laws leave unexplained, held against the other runs.
struct OddLaws {
  std::vector<double> most{};      ///< by law: greatest unexplained share of the other runs
  std::vector<std::size_t> odd{};  ///< laws that this run breaks and no other run breaks
  bool suspect{};                  ///< the odd laws are of different kinds: no effect breaks both in one run
};

/// Holds run `run` against the others. A law that too few other runs have is never odd.
[[nodiscard]] OddLaws odd_laws(const std::vector<Relations>& relations, std::size_t run);

/// Gain of a repair in nats, summed over the odd laws; none where a law stays odd or becomes odd.
[[nodiscard]] std::optional<double> repair_gain(const OddLaws& laws, const Relations& logged,
                                                const Relations& repaired);

}  // namespace joulepath
