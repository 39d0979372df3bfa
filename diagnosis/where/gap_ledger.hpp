#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// Joules of a cell in one run.
struct GapAmount {
  double gap_J{};       ///< sum of |predicted - measured|
  double noise_J{};     ///< expected from noise alone
  double signed_J{};    ///< sum of predicted - measured
  double measured_J{};  ///< sum of |measured|; 0 where the cell has no energy (a channel)

  double excess_J() const { return gap_J > noise_J ? gap_J - noise_J : 0.0; }
  void add(const GapAmount& more);
};

/// Collects the gap by axis, cell and run and computes shares: the share of noise is subtracted, the shares
/// over one axis add up to 1, and intervals come from resampling whole runs.
class GapLedger {
 public:
  explicit GapLedger(std::size_t runs) : runs_(runs) {}

  void book(const std::string& axis, const std::string& value, std::size_t run, const GapAmount& amount);

  /// Cells of the given axes, in decreasing order of their share.
  [[nodiscard]] std::vector<WhereCell> cells(const std::vector<std::string>& axes,
                                             std::size_t bootstrap) const;

 private:
  using Cells = std::map<std::string, std::vector<GapAmount>>;  ///< value -> run -> amount
  std::vector<WhereCell> cells_of(const std::string& axis, const Cells& cells, std::size_t bootstrap) const;

  std::size_t runs_;
  std::map<std::string, Cells> axes_{};
};

/// "low to high unit": name of a cell of a continuous axis.
[[nodiscard]] std::string range_text(double low, double high, const char* unit);

/// "value unit", with two decimals.
[[nodiscard]] std::string number_text(double value, const char* unit);

}  // namespace joulepath
