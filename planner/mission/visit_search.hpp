#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/mission/visit_table.hpp"

namespace joulepath {

inline constexpr std::size_t kExactStops = 10;  ///< all labels are kept up to this number of stops
inline constexpr std::size_t kBeam = 2000;      ///< kept labels of a layer above that number

/// A partial order: visited stops, place and load of the robot.
struct VisitLabel {
  std::uint64_t visited{};
  std::size_t last{};  ///< visit index; visits.size() = the start
  double payload_kg{};
  TimeFront front{{0.0, 0.0}};  ///< of the departure
  double heaviest_kg{};         ///< carried so far
  double late_s{};              ///< at a stop, if windows are relaxed
  std::vector<std::size_t> order{};
};

/// Constraints that a search ignores, to find the one that prevents an order.
struct RelaxedVisits {
  bool windows{};  ///< the end of every stop's
  bool capacity{};
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

  /// The order in which the stops are listed; nothing if it violates a window or the capacity.
  [[nodiscard]] std::optional<double> given_order_J() const;

  /// A lower bound on the energy of every order: the cheapest way into each stop, without payload.
  [[nodiscard]] double lower_bound_J() const;

  /// The first stop that cannot be reached from the start, or nothing.
  [[nodiscard]] std::optional<std::size_t> unreachable() const;

 private:
  using Layer = std::vector<VisitLabel>;
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
