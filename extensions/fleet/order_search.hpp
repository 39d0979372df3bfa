#pragma once

#include "extensions/fleet/order_cost.hpp"
#include "extensions/fleet/route_driver.hpp"

namespace joulepath {

/// Orders of missions by insertion where they cost least, from the one that is due first on.
[[nodiscard]] Orders inserted_orders(const RoutingProblem& problem);

/// Orders near others: strings of missions are taken out of some routes and inserted anew
/// [Christiaens2020]. The problem outlives it.
class OrderNeighborhood {
 public:
  explicit OrderNeighborhood(const RoutingProblem& problem);
  [[nodiscard]] Orders of(const Orders& orders, Random& chance) const;

 private:
  std::vector<int> take_out(Orders& orders, Random& chance) const;
  void sort(std::vector<int>& taken, Random& chance) const;

  const RoutingProblem& problem_;
  OrderCost cost_;
  std::vector<std::vector<int>> near_{};  ///< of each mission: itself, then all others, the nearest first
};

/// Simulated annealing over orders, from orders that can be driven at a known cost. There is a mission.
class OrderSearch {
 public:
  OrderSearch(const RoutingProblem& problem, Orders orders, std::int64_t cost, std::uint64_t seed,
              std::size_t rounds);

  /// Goes on for so many rounds, within those of the search. The best routes so far where they are new and
  /// cheaper than the known cost, else null.
  [[nodiscard]] std::optional<DrivenRoutes> advance(std::size_t rounds);

 private:
  OrderNeighborhood neighborhood_;
  RouteDriver driver_;
  Random chance_;
  Orders here_;
  std::int64_t here_cost_, best_cost_, wait_s_{};
  double missions_;
  std::size_t round_{}, rounds_;
};

}  // namespace joulepath
