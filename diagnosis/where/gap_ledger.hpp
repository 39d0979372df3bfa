#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// Joules of a cell in one run.
struct GapAmount {
  double gap_J{};       ///< sum of |predicted - measured|
  double noise_J{};     ///< what noise alone gives
  double signed_J{};    ///< sum of predicted - measured
  double measured_J{};  ///< sum of |measured|; 0 where the cell has no energy of its own (a channel)

  double excess_J() const { return gap_J > noise_J ? gap_J - noise_J : 0.0; }
  void add(const GapAmount& more);
};

/// Books the gap by axis, cell and run, and shares it out: the share of noise is subtracted, shares over one
/// axis add up to 1, intervals come from resampling whole runs.
class GapLedger {
 public:
  explicit GapLedger(std::size_t runs) : runs_(runs) {}

  void book(const std::string& axis, const std::string& value, std::size_t run, const GapAmount& amount);

  /// The axes in the order asked for, each with its cells from the greatest share down.
  [[nodiscard]] std::vector<WhereCell> cells(const std::vector<std::string>& axes,
                                             std::size_t bootstrap) const;

 private:
  using Cells = std::map<std::string, std::vector<GapAmount>>;  ///< value -> run -> amount
  std::vector<WhereCell> cells_of(const std::string& axis, const Cells& cells, std::size_t bootstrap) const;

  std::size_t runs_;
  std::map<std::string, Cells> axes_{};
};

/// "low to high unit", as cells of a continuous axis are called.
[[nodiscard]] std::string range_text(double low, double high, const char* unit);

/// "value unit", to two decimals.
[[nodiscard]] std::string number_text(double value, const char* unit);

}  // namespace joulepath
