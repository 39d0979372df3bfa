#pragma once

#include <span>
#include <vector>

#include "extensions/fleet/random.hpp"
#include "extensions/fleet/routing_problem.hpp"
#include "model/limits.hpp"

namespace joulepath {

/// An estimate of what orders of missions cost, in tenths of a joule. Ways have their cheapest speed,
/// missions too, or their quickest where they would be late. What a battery lacks is charged at once, at the
/// power of the fastest charger. The problem outlives it.
class OrderCost {
 public:
  /// Of a robot after a mission of an order.
  struct State {
    int place{};
    double clock_s{};
    double used{};  ///< of what the battery holds above the reserve, in tenths of a joule
    double paid{};  ///< motion and lateness, in tenths of a joule
  };
  struct Insertion {
    double extra{kNoLimit};
    std::size_t position{};
  };

  explicit OrderCost(const RoutingProblem& problem);

  /// Before the first mission, and after each one.
  [[nodiscard]] std::vector<State> states(int robot, std::span<const int> order) const;
  /// Of an order's states, with standby and the robot's use.
  [[nodiscard]] double total(int robot, const std::vector<State>& states) const;
  /// The least extra cost of a mission in an order with these states, where one costs less than `below`; else
  /// infinite. `chance` skips places now and then.
  [[nodiscard]] Insertion insertion(int robot, std::span<const int> order, const std::vector<State>& states,
                                    int mission, double below, Random* chance) const;

 private:
  void advance(int robot, int mission, State& at) const;
  double extra(int robot, std::span<const int> order, const std::vector<State>& states, int mission,
               std::size_t position, double below) const;
  double ended(int robot, const State& last) const;
  double charging(int robot, double used) const;

  const RoutingProblem& problem_;
  std::vector<double> held_{};   ///< of each robot's battery, above the reserve
  std::vector<double> power_{};  ///< of the fastest charger, standby subtracted, for each type
};

}  // namespace joulepath
