#include "extensions/fleet/order_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

// Design: docs/decisions/0701-python.md
namespace joulepath {
namespace {

constexpr double kRemoved = 10;   ///< missions of one removal, on average
constexpr double kLongest = 10;   ///< of the strings
constexpr double kFarPerS = 0.1;  ///< of two missions, for each second between their ready times
/// Shares of a mission's mean cost: about so much dearer orders are kept at the begin and at the end.
constexpr double kFirstTemperature = 0.6, kLastTemperature = 0.02;
constexpr double kRobotsFree = 0.1;    ///< chance that robots cost nothing in a round
constexpr std::size_t kSameWait = 20;  ///< rounds

using States = std::vector<std::vector<OrderCost::State>>;

States states_of(const OrderCost& cost, const Orders& orders) {
  States states;
  for (std::size_t r = 0; r < orders.size(); ++r)
    states.push_back(cost.states(static_cast<int>(r), orders[r]));
  return states;
}

/// How missions are inserted.
struct Insertion {
  Random* chance{};    ///< skips places now and then
  bool robots_free{};  ///< the use of a robot without missions costs nothing: two missions may be worth it
};

/// Inserts a mission where it costs least; of equal robots without missions one is tried.
void insert(const RoutingProblem& problem, const OrderCost& cost, Orders& orders, States& states, int m,
            const Insertion& how) {
  const std::vector<int>& robots = problem.mission(m).robots;
  OrderCost::Insertion best;
  int robot = robots.front();
  std::set<int> empty;
  for (const int r : robots) {
    const auto index = static_cast<std::size_t>(r);
    if (orders[index].empty() && !empty.insert(problem.robot(r).likeness).second) continue;
    const double free =
        how.robots_free && orders[index].empty() ? static_cast<double>(problem.robot(r).use_price) : 0.0;
    auto found = cost.insertion(r, orders[index], states[index], m, best.extra + free, how.chance);
    found.extra -= free;
    if (found.extra >= best.extra) continue;
    best = found;
    robot = r;
  }
  std::vector<int>& order = orders[static_cast<std::size_t>(robot)];
  order.insert(order.begin() + static_cast<std::ptrdiff_t>(best.position), m);
  states[static_cast<std::size_t>(robot)] = cost.states(robot, order);
}

/// Missions are near each other where one can follow the other soon.
double far_s(const RoutingProblem& problem, int a, int b) {
  if (a == b) return -1;
  const auto &one = problem.mission(a), &other = problem.mission(b);
  const auto type = static_cast<int>(
      std::find_if(one.drives.begin(), one.drives.end(), [](const auto& d) { return !d.empty(); }) -
      one.drives.begin());
  double way_s = kNoLimit;
  for (const auto* way :
       {&problem.way(type, one.last, other.first), &problem.way(type, other.last, one.first)})
    if (!way->empty()) way_s = std::min(way_s, static_cast<double>(way->front().duration_s));
  return (way_s < kNoLimit ? way_s : 0.0) +
         kFarPerS * std::abs(static_cast<double>(one.ready_s - other.ready_s));
}

}  // namespace

Orders inserted_orders(const RoutingProblem& problem) {
  const OrderCost cost(problem);
  Orders orders(problem.robots.size());
  States states = states_of(cost, orders);
  std::vector<int> missions(problem.missions.size());
  std::iota(missions.begin(), missions.end(), 0);
  std::stable_sort(missions.begin(), missions.end(),
                   [&](int a, int b) { return problem.mission(a).due_s < problem.mission(b).due_s; });
  for (const int m : missions) insert(problem, cost, orders, states, m, {});
  return orders;
}

OrderNeighborhood::OrderNeighborhood(const RoutingProblem& problem) : problem_(problem), cost_(problem) {
  const auto count = static_cast<int>(problem.missions.size());
  for (int center = 0; center < count; ++center) {
    std::vector<std::pair<double, int>> found;
    for (int m = 0; m < count; ++m) found.emplace_back(far_s(problem, center, m), m);
    std::sort(found.begin(), found.end());
    std::vector<int>& near = near_.emplace_back();
    for (const auto& [_, m] : found) near.push_back(m);
  }
}

Orders OrderNeighborhood::of(const Orders& orders, Random& chance) const {
  Orders left = orders;
  std::vector<int> taken = take_out(left, chance);
  States states = states_of(cost_, left);
  sort(taken, chance);
  const Insertion how{&chance, chance.uniform() < kRobotsFree};
  for (const int m : taken) insert(problem_, cost_, left, states, m, how);
  return left;
}

/// Removes strings of some routes, near a mission.
std::vector<int> OrderNeighborhood::take_out(Orders& orders, Random& chance) const {
  std::vector<std::size_t> robot_of(problem_.missions.size());
  double used = 0;
  for (std::size_t r = 0; r < orders.size(); ++r) {
    used += orders[r].empty() ? 0 : 1;
    for (const int m : orders[r]) robot_of[static_cast<std::size_t>(m)] = r;
  }
  const double longest =
      std::max(1.0, std::min(kLongest, static_cast<double>(problem_.missions.size()) / std::max(1.0, used)));
  const auto strings = static_cast<std::size_t>(chance.uniform(1, 4 * kRemoved / (1 + longest)));
  std::vector<int> taken;
  std::vector<bool> touched(orders.size(), false);
  std::size_t count = 0;
  for (const int m : near_[chance.below(near_.size())]) {
    const std::size_t r = robot_of[static_cast<std::size_t>(m)];
    if (touched[r]) continue;
    touched[r] = true;
    std::vector<int>& order = orders[r];
    const auto size = static_cast<std::ptrdiff_t>(order.size());
    const double drawn = chance.uniform(1, 1 + std::min(longest, static_cast<double>(size)));
    const std::ptrdiff_t length = std::min(size, static_cast<std::ptrdiff_t>(drawn));
    const std::ptrdiff_t at = std::find(order.begin(), order.end(), m) - order.begin();
    const std::ptrdiff_t least = std::max<std::ptrdiff_t>(0, at - length + 1),
                         most = std::min(at, size - length);
    const auto first = order.begin() + least +
                       static_cast<std::ptrdiff_t>(chance.below(static_cast<std::size_t>(most - least + 1)));
    taken.insert(taken.end(), first, first + length);
    order.erase(first, first + length);
    if (++count >= strings) break;
  }
  return taken;
}

void OrderNeighborhood::sort(std::vector<int>& taken, Random& chance) const {
  chance.shuffle(taken);
  const auto by = [&](const auto& key) {
    std::stable_sort(taken.begin(), taken.end(),
                     [&](int a, int b) { return key(problem_.mission(a)) < key(problem_.mission(b)); });
  };
  using Mission = RoutingProblem::Mission;
  const std::size_t rule = chance.below(4);
  if (rule == 1) by([](const Mission& x) { return x.due_s; });
  if (rule == 2) by([](const Mission& x) { return x.ready_s; });
  if (rule == 3)
    by([](const Mission& x) {
      std::int64_t most = 0;
      for (const auto& drives : x.drives)
        if (!drives.empty()) most = std::max(most, drives.front().motion);
      return -most;
    });
}

OrderSearch::OrderSearch(const RoutingProblem& problem, Orders orders, std::int64_t cost, std::uint64_t seed,
                         std::size_t rounds)
    : neighborhood_(problem),
      driver_(problem),
      chance_(seed),
      here_(std::move(orders)),
      here_cost_(cost),
      best_cost_(cost),
      missions_(static_cast<double>(problem.missions.size())),
      rounds_(rounds) {}

std::optional<DrivenRoutes> OrderSearch::advance(std::size_t rounds) {
  std::optional<DrivenRoutes> best;
  for (const std::size_t end = std::min(rounds_, round_ + rounds); round_ < end; ++round_) {
    Orders tried = neighborhood_.of(here_, chance_);
    if (round_ % kSameWait == 0) wait_s_ = kWaits_s[chance_.below(kWaits_s.size())];
    std::optional<DrivenRoutes> found = driver_.drive(tried, wait_s_);
    const double share = static_cast<double>(round_) / static_cast<double>(rounds_),
                 temperature = kFirstTemperature * std::pow(kLastTemperature / kFirstTemperature, share) *
                               static_cast<double>(best_cost_) / missions_,
                 threshold = static_cast<double>(here_cost_) - temperature * std::log(1 - chance_.uniform());
    if (!found || static_cast<double>(found->cost) >= threshold) continue;
    here_ = std::move(tried);
    here_cost_ = found->cost;
    if (found->cost >= best_cost_) continue;
    best_cost_ = found->cost;
    best = std::move(found);
  }
  return best;
}

}  // namespace joulepath
