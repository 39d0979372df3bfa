#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace joulepath {

/// A fleet in numbers: times in whole seconds, energies and prices in tenths of a joule, powers per second.
/// Rounded by python/joulepath/fleet/_problem.py, which states each field.
struct RoutingProblem {
  struct Drive {
    std::int64_t duration_s{}, motion{}, upper{};
  };
  /// Of a way or a mission, from the cheapest to the quickest.
  using Drives = std::vector<Drive>;
  struct Type {
    std::int64_t capacity{}, reserve{}, standby{};
  };
  struct Robot {
    int type{}, start{};
    std::int64_t level{}, from_s{}, to_s{}, use_price{};
    int likeness{};  ///< the same of robots that differ by their names alone
  };
  struct Charger {
    int place{}, count{};
    std::int64_t power{}, taper{};
    std::vector<std::int64_t> knees{};  ///< level, of each type
  };
  struct Mission {
    int first{}, last{};
    std::int64_t ready_s{}, due_s{}, late_price{};
    std::vector<int> robots{};
    std::vector<Drives> drives{};  ///< of each type; empty: may not drive it
  };
  struct Busy {
    int charger{};
    std::int64_t from_s{}, to_s{};
  };

  int places{};
  std::vector<Type> types{};
  std::vector<Robot> robots{};
  std::vector<Charger> chargers{};
  std::vector<Mission> missions{};
  std::vector<Drives> ways{};  ///< (type, from, to), row-major; empty: no way
  std::vector<Busy> busy{};    ///< visits of other robots

  [[nodiscard]] const Drives& way(int type, int from, int to) const {
    const int index = (type * places + from) * places + to;
    return ways[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] const Robot& robot(int r) const { return robots[static_cast<std::size_t>(r)]; }
  [[nodiscard]] const Type& type_of(int r) const { return types[static_cast<std::size_t>(robot(r).type)]; }
  [[nodiscard]] const Charger& charger(int c) const { return chargers[static_cast<std::size_t>(c)]; }
  [[nodiscard]] const Mission& mission(int m) const { return missions[static_cast<std::size_t>(m)]; }
  [[nodiscard]] const Drives& drives(int m, int type) const {
    return mission(m).drives[static_cast<std::size_t>(type)];
  }
};

/// The missions of each robot, in their order.
using Orders = std::vector<std::vector<int>>;

/// A charge on the way to a mission.
struct ChargerVisit {
  int charger{};
  std::int64_t from_s{}, to_s{};
  std::int64_t target{};  ///< level at its end
  bool operator==(const ChargerVisit&) const = default;
};

/// A mission in a robot's route: the speeds of the way to it (0 with a visit) and of its own.
struct RouteStep {
  int mission{}, way{}, speed{};
  std::int64_t start_s{};
  std::optional<ChargerVisit> visit{};
  bool operator==(const RouteStep&) const = default;
};

using Routes = std::vector<std::vector<RouteStep>>;

}  // namespace joulepath
