#pragma once

#include "extensions/onboard/monitor/monitor_row.hpp"
#include "model/robot.hpp"

namespace joulepath {

/// Energy at the battery's terminals, from the best channels that a row has: the battery's own; else the
/// motors' power, or their voltages and currents, plus standby. Gaps are bridged linearly and counted.
class EnergyMeter {
 public:
  explicit EnergyMeter(const PowerSupply& supply) : supply_(supply) {}

  void add(const MonitorRow& row);
  [[nodiscard]] double energy_J() const { return energy_J_; }
  [[nodiscard]] double bridged_s() const { return bridged_s_; }  ///< without a reading
  [[nodiscard]] bool measures() const { return !(last_W_ != last_W_); }

 private:
  [[nodiscard]] double power_W(const MonitorRow& row) const;

  PowerSupply supply_;
  double last_s_{kAbsent}, last_W_{kAbsent}, energy_J_{}, bridged_s_{};
};

}  // namespace joulepath
