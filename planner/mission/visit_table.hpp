#pragma once

#include <array>
#include <optional>
#include <vector>

#include "planner/mission/time_front.hpp"
#include "planner/ways/mission_ways.hpp"

namespace joulepath {

/// Whether a stop of `visit:` has a window.
[[nodiscard]] bool has_windows(const MissionRequest& mission);

/// Cost and time of the legs between every two stops, from inner profile solves at three payloads,
/// interpolated between them. Index `visits` is the start. If stops have windows, a leg is measured at
/// several prices of time.
class VisitTable {
 public:
  explicit VisitTable(const ChoiceContext& context);

  [[nodiscard]] bool reachable(std::size_t from, std::size_t to) const { return cost(from, to).reachable; }
  /// Cost of a leg over its time, at the mission's own price, for a payload, by what was learned.
  [[nodiscard]] TimeFront front(std::size_t from, std::size_t to, double payload_kg) const;
  /// The mission's price of a second, in addition to standby.
  [[nodiscard]] double price_W() const { return price_W_; }
  /// Corrects the cost of a leg, at any payload, by what a plan of it cost (J, time at its price included).
  /// Legs without such a plan count as a little cheaper, relative to their estimate, than any planned one.
  void learn(std::size_t from, std::size_t to, double payload_kg, double planned_J);
  /// Energy of the cheapest drive without payload.
  [[nodiscard]] double unloaded_J(std::size_t from, std::size_t to) const {
    return cost(from, to).drives.back().energy_J[0];
  }

 private:
  struct Drive {
    std::array<double, 3> energy_J{};  ///< at zero, half and the largest payload
    std::array<double, 3> duration_s{};
  };
  struct LegCost {
    bool reachable{};
    std::optional<double> factor{};  ///< of a plan's cost to the estimate
    std::vector<Drive> drives{};     ///< from the highest price of time to the mission's own
  };

  const LegCost& cost(std::size_t from, std::size_t to) const { return table_[from * count_ + to]; }
  TimeFront estimate(std::size_t from, std::size_t to, double payload_kg, double factor) const;
  LegCost measure(const ChoiceContext& context, std::size_t from, std::size_t to) const;

  std::size_t count_;
  double price_W_;
  double heaviest_kg_{};
  double rest_{1};  ///< factor of legs without one
  std::vector<LegCost> table_{};
};

}  // namespace joulepath
