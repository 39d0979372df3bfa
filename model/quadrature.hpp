#pragma once

#include <array>

#include "model/energy.hpp"
// Design: docs/decisions/0101-limits-and-energy.md
namespace joulepath {

/// The input of the power model at an instant: speeds and accelerations, and the site with the
/// memories of the effects.
struct MotionInstant {
  BodyMotion<double> motion{};
  Site site{};
  bool stands{};  ///< both wheels stand: brakes and friction hold the robot, the motors carry no current
};

/// A node of the energy integral.
struct EnergyNode {
  double time_s{};
  double weight_s{};
  MotionInstant instant{};
  Sided<WheelState<double>> wheels{};
};

[[nodiscard]] EnergyNode energy_node(const Plant& plant, const MotionInstant& instant, double time_s,
                                     double weight_s = 0.0);

/// Power (W) that the drives take from the supply at a node, without standby.
[[nodiscard]] double drive_power_W(const Plant& plant, const EnergyNode& node);

/// The branch of every piecewise law at a node: the signs of the motors' power (recovered or not), the
/// directions of dry friction, and with effects the signs of current and of the body's speeds, and branch()
/// of effects with a region. Within a branch power is a smooth function of time.
[[nodiscard]] unsigned long branch_of(const Plant& plant, const EnergyNode& node);

inline constexpr std::array<double, 3> kGaussPlaces{0.1127016653792583, 0.5, 0.8872983346207417};
inline constexpr std::array<double, 3> kGaussWeights{5.0 / 18, 8.0 / 18, 5.0 / 18};

/// The energy integral of a motion over an interval in which `instant_at(time_s)` is smooth apart from the
/// branches of the laws: three Gauss-Legendre points, on halves where the branch changes, 12 times at most
/// (the change is located to 1/4096 of the interval). Calls visit(node) in the order of time.
template <class InstantAt, class Visit>
void integrate(const Plant& plant, InstantAt&& instant_at, double from_s, double to_s, Visit&& visit,
               int halvings = 12) {
  const double length_s = to_s - from_s, edge_s = 1e-9 * length_s;
  const auto node_at = [&](double time_s, double weight_s) {
    return energy_node(plant, instant_at(time_s), time_s, weight_s);
  };
  unsigned long branch = 0;
  bool one_branch = true;
  if (halvings > 0) {
    branch = branch_of(plant, node_at(from_s + edge_s, 0));
    one_branch = branch == branch_of(plant, node_at(to_s - edge_s, 0));
  }
  if (one_branch) {
    std::array<EnergyNode, 3> nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      nodes[i] = node_at(from_s + kGaussPlaces[i] * length_s, kGaussWeights[i] * length_s);
      one_branch &= halvings == 0 || branch == branch_of(plant, nodes[i]);
    }
    if (one_branch) {
      for (const EnergyNode& node : nodes) visit(node);
      return;
    }
  }
  const double middle_s = 0.5 * (from_s + to_s);
  integrate(plant, instant_at, from_s, middle_s, visit, halvings - 1);
  integrate(plant, instant_at, middle_s, to_s, visit, halvings - 1);
}

/// Sums up the nodes of the energy integral.
class EnergySum {
 public:
  explicit EnergySum(const Plant& plant)
      : plant_(&plant), joules_{.effect_W = std::vector<double>(plant.effects.size(), 0.0)} {}

  void add(const EnergyNode& node);

  /// At the battery's terminals, standby included.
  [[nodiscard]] EnergyByCause by_cause() const;
  const Sided<double>& motor_J() const { return motor_J_; }      ///< V i as it is
  const Sided<double>& counted_J() const { return counted_J_; }  ///< of each motor, max(P, eta P)
  double battery_loss_J() const { return battery_loss_J_; }      ///< in the internal resistance
  double lowest_voltage_V() const { return lowest_voltage_V_; }  ///< at the battery's terminals
  double distance_m() const { return distance_m_; }

 private:
  const Plant* plant_;
  PowerByCause joules_{};  ///< integrals of its watts
  Sided<double> motor_J_{};
  Sided<double> counted_J_{};
  double battery_loss_J_{};
  double lowest_voltage_V_{kNoLimit};
  double distance_m_{};
};

}  // namespace joulepath
