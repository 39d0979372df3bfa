#pragma once

#include <string>
#include <vector>

namespace joulepath::nlp {

/// A solver's solution of a Problem.
struct Solution {
  bool converged{};
  std::vector<double> b{};  ///< squares of the rate at all nodes, fixed ends included
  std::vector<double> z{};  ///< energy not recovered, [segment][channel]
  double objective{};
  double price_W{};                           ///< multiplier of the duration row: -d objective/d duration
  std::vector<double> row_multiplier{};       ///< per ActiveRow, positive at its upper bound
  std::vector<double> recovery_multiplier{};  ///< of E + z >= 0, >= 0, [segment][channel]
  std::vector<double> cap_multiplier{};       ///< per node, >= 0; of the fast solver only
  int iterations{};
  std::string message{};
};

}  // namespace joulepath::nlp
