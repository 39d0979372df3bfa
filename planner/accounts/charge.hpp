#pragma once

#include <algorithm>

#include "model/battery_charge.hpp"
#include "model/battery_power.hpp"
#include "model/watt_hours.hpp"

namespace joulepath {

/// State of charge over the legs of a plan.
class Charge {
 public:
  Charge(const Battery& battery, double start_fraction)
      : battery_(battery),
        capacity_J_(battery.capacity_Wh * kJoulesPerWh),
        start_(start_fraction),
        full_J_(-energy_share_between(battery, start_fraction, 1.0) * capacity_J_) {}

  double fraction() const { return fraction_after(battery_, start_, net_J_); }
  double peak_J() const { return peak_J_; }

  /// A full battery takes up nothing.
  void draw(double energy_J) {
    net_J_ = std::max(net_J_ + energy_J, full_J_);
    peak_J_ = std::max(peak_J_, net_J_ - least_net_J_);
  }
  /// Charges for a time, at most up to a fraction; returns the energy at the terminals.
  double take_up(double power_W, double duration_s, double to_fraction) {
    const double stored_W = stored_power_W(battery_, fraction(), power_W),
                 accepted_W = accepted_power_W(battery_, fraction(), power_W);
    const double stored_J = std::clamp(energy_share_between(battery_, fraction(), to_fraction) * capacity_J_,
                                       0.0, std::max(0.0, stored_W * duration_s));
    net_J_ -= stored_J;
    least_net_J_ = std::min(least_net_J_, net_J_);
    return stored_W > 0 ? stored_J * accepted_W / stored_W : 0.0;
  }

 private:
  const Battery& battery_;
  double capacity_J_;
  double start_;
  double full_J_;  ///< of net_J_, at most 0
  double net_J_{};
  double least_net_J_{};  ///< where the battery was fullest
  double peak_J_{};       ///< the greatest discharge from there on
};

}  // namespace joulepath
