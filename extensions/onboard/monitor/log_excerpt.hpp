#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/checks/implausible.hpp"
#include "diagnosis/values/dataset.hpp"
#include "extensions/onboard/monitor/monitor_row.hpp"

namespace joulepath {

/// Appends a row to the channels of a log; NaN where it has no reading.
void append_row(const MonitorRow& row, double payload_kg, Trajectory& log);

/// The latest rows of a live log, judged by the checks of logs in files: each time that their number has
/// doubled, and from `kMostRows` on each time that half of them are new.
class LogExcerpt {
 public:
  explicit LogExcerpt(const Robot& robot);

  /// Takes a row, later than the one before; what the checks find suspect in the rows so far.
  [[nodiscard]] std::optional<Implausible> add(const MonitorRow& row, double payload_kg);
  /// The same of all rows so far.
  [[nodiscard]] std::optional<Implausible> judged() const;

 private:
  static constexpr std::size_t kFirstRows = 128, kMostRows = 16384;

  void drop_first_half();

  Dataset dataset_{};  ///< of one run
  std::size_t next_{kFirstRows};
};

}  // namespace joulepath
