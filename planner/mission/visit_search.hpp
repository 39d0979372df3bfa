#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/mission/visit_table.hpp"

namespace joulepath {

inline constexpr std::size_t kExactStops = 10;  ///< all labels are kept up to this number of stops
inline constexpr std::size_t kBeam = 2000;      ///< kept labels of a layer above that number
inline constexpr std::size_t kAllOrders = 5;  ///< up to this number of stops no order is dropped for another

/// A partial order: visited stops, place and load of the robot.
struct VisitLabel {
  std::uint64_t visited{};
  std::size_t last{};  ///< visit index; visits.size() = the start
  double payload_kg{};
  TimeFront front{{0.0, 0.0}};  ///< of the departure; a second costs the mission's price beside its energy
  double free_cost_J{};         ///< of the cheapest drives, were there no windows
  double heaviest_kg{};         ///< carried so far
  double late_s{};              ///< at a stop, if windows are relaxed
  double late_share{};          ///< the same as a share of the arrival
  std::vector<std::size_t> order{};
};

/// Constraints that a search ignores.
struct RelaxedVisits {
  bool windows{};  ///< the end of every stop's
  bool capacity{};
  bool beaten{};  ///< orders that the table calls worse in everything are kept, too, up to kAllOrders stops
};

/// The robot's load after a stop; below zero if it drops more than it has.
[[nodiscard]] double payload_after_kg(const VisitRequest& visit, double payload_kg);

/// Label setting over subsets of the stops.
class VisitSearch {
 public:
  explicit VisitSearch(const ChoiceContext& context);

  /// Orders of all stops: the one of least cost (least lateness, if windows are relaxed) first, then those
  /// that end elsewhere or could be cheaper in another time.
  [[nodiscard]] std::vector<VisitLabel> orders(const RelaxedVisits& relaxed = {}) const;

  /// Energy of an order; nothing if it violates a window or the capacity.
  [[nodiscard]] std::optional<double> order_J(const std::vector<std::size_t>& order) const;

  /// Corrects the costs of an order's legs by a plan of it. Where the plan has stops at chargers, nothing is
  /// learned.
  void learn(const std::vector<std::size_t>& order, const Plan& plan);

  /// Energy of a label's cheapest drives within its windows.
  [[nodiscard]] double energy_J(const VisitLabel& label) const {
    return label.front.least_J() - table_.price_W() * label.front.cheapest_s();
  }

  /// The table's cheapest way into each stop, without payload, summed.
  [[nodiscard]] double lower_bound_J() const;

  /// The first stop that cannot be reached from the start, or nothing.
  [[nodiscard]] std::optional<std::size_t> unreachable() const;

 private:
  using Layer = std::vector<VisitLabel>;
  /// Cost of a second at rest.
  double second_J() const { return standby_W_ + table_.price_W(); }
  bool allowed(const VisitLabel& label, std::size_t next) const;
  std::optional<VisitLabel> extend(const VisitLabel& label, std::size_t next,
                                   const RelaxedVisits& relaxed) const;
  Layer next_layer(const Layer& layer, const RelaxedVisits& relaxed) const;

  const std::vector<VisitRequest>& visits_;
  std::size_t count_;
  double standby_W_;
  double capacity_kg_;
  VisitTable table_;
};

}  // namespace joulepath
