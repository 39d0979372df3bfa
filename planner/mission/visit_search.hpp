#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planner/mission/visit_table.hpp"

namespace joulepath {

inline constexpr std::size_t kExactStops = 10;  ///< up to here no label is dropped
inline constexpr std::size_t kBeam = 2000;      ///< labels of a layer that are kept beyond

/// A partial order: what is visited, where the robot is, what it carries.
struct VisitLabel {
  std::uint64_t visited{};
  std::size_t last{};  ///< visit index; visits.size() = the start
  double payload_kg{};
  TimeFront front{{0.0, 0.0}};  ///< of the departure
  double heaviest_kg{};         ///< carried so far
  double late_s{};              ///< at the stop whose window is relaxed
  std::vector<std::size_t> order{};
};

/// What a search may ignore, to find the constraint that prevents an order.
struct RelaxedVisits {
  std::optional<std::size_t> window{};  ///< the end of this stop's
  bool capacity{};
  double late_share{};  ///< of the arrival's time, at every window
};

/// What the robot carries after a stop; below zero where it drops more than it has.
[[nodiscard]] double payload_after_kg(const VisitRequest& visit, double payload_kg);

/// Label setting over subsets of the stops.
class VisitSearch {
 public:
  explicit VisitSearch(const ChoiceContext& context);

  /// The order of least cost (least late, where a window is relaxed); nothing where there is none.
  [[nodiscard]] std::optional<VisitLabel> best(const RelaxedVisits& relaxed = {}) const;

  /// Of the stops in the order in which they are listed; nothing where that breaks a window or the capacity.
  [[nodiscard]] std::optional<double> given_order_J() const;

  /// No order takes less: the cheapest way into each stop, without payload.
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
