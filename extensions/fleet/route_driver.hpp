#pragma once

#include <array>
#include <span>

#include "extensions/fleet/routing_problem.hpp"

namespace joulepath {

struct DrivenRoutes {
  Routes routes{};
  std::int64_t cost{};  ///< tenths of a joule
};

/// Mean energy with standby, lateness and use of all routes, in tenths of a joule.
[[nodiscard]] std::int64_t routes_cost(const RoutingProblem& problem, const Routes& routes);

/// Waits at chargers that orders are driven for.
constexpr std::array<std::int64_t, 3> kWaits_s{0, 200, 800};

/// Drives robots one step at a time. Chargers serve in the order of calls. Places, ways and numbers of the
/// problem are valid, and the problem outlives the driver.
class RouteDriver {
 public:
  explicit RouteDriver(const RoutingProblem& problem);

  /// Robots drive their missions in a given order, each step by the robot that is free first. One charges
  /// where its next mission would not leave it the way to a charger, with standby for a wait there. Null
  /// where a battery or a shift ends.
  [[nodiscard]] std::optional<DrivenRoutes> drive(const Orders& orders, std::int64_t wait_s);
  /// The cheapest of several waits.
  [[nodiscard]] std::optional<DrivenRoutes> drive(const Orders& orders,
                                                  std::span<const std::int64_t> waits_s);

  /// The dispatcher of the field: the next mission goes to the nearest robot that is free; below a share
  /// `low` of its battery it charges until a share `high`.
  [[nodiscard]] std::optional<DrivenRoutes> dispatch(double low, double high);

 private:
  struct At {
    int place{};
    std::int64_t clock{}, level{};
  };
  struct Charge {
    int charger{};
    std::int64_t target{};
  };
  using Type = RoutingProblem::Type;

  void begin();
  DrivenRoutes result() const { return {routes_, routes_cost(problem_, routes_)}; }
  const Type& type_of(int r) const { return problem_.type_of(r); }
  std::int64_t free_from(int charger, std::int64_t time_s, std::int64_t duration_s) const;
  std::int64_t charge_s(int charger, int r, std::int64_t level, std::int64_t target) const;
  std::int64_t to_dock(int r, int place) const;
  std::int64_t needed(int r, int m, int place, std::int64_t clock) const;
  std::int64_t rest(int r, std::span<const int> order) const;
  std::optional<ChargerVisit> charged(int r, const Charge& charge) const;
  bool go(int r, int m, const std::optional<Charge>& charge);
  bool next(int r, std::span<const int> order, std::int64_t wait_s);
  bool dispatch(int r, int m, double low, double high);
  std::vector<int> chargers_by(int r, bool by_queue) const;

  const RoutingProblem& problem_;
  std::vector<std::int64_t> to_dock_{};  ///< (type, place)
  std::vector<At> at_{};
  Routes routes_{};
  struct Taken {
    std::int64_t from_s, to_s;
  };
  std::vector<std::vector<Taken>> taken_{};  ///< of each charger
};

}  // namespace joulepath
