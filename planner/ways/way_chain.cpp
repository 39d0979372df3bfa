#include "planner/ways/way_chain.hpp"

#include <algorithm>

// Method: [Bellman1957]
namespace joulepath {
namespace {

constexpr auto kNone = static_cast<std::size_t>(-1);

/// Turning at a stop between two ways: at the end of the earlier leg, at the start of the later one, or both.
struct Joint {
  PathScore before{.drivable = true};
  PathScore after{.drivable = true};
  std::optional<double> heading_rad{};  ///< turned to at the end of the earlier leg
  double cost_J{};
};

class Chain {
 public:
  explicit Chain(const ChainRequest& request) : request_(request) {}

  /// The joint between two ways; leg 0 begins at the mission's start.
  Joint joint(std::size_t leg, const Way* before, const Way* after) const {
    if (!before) return after ? from_start(*after) : Joint{};
    const ChainLeg& earlier = request_.legs[leg - 1];
    if (earlier.goal_heading_rad || !after) {
      Joint joint = arrival(earlier, *before);
      if (after) depart(leg, earlier.goal, *joint.heading_rad, *after, joint);
      return joint;
    }
    return free_stop(leg, *before, *after);
  }

 private:
  static void charge(Joint& joint, const PathScore& score, double price_W, bool before) {
    (before ? joint.before : joint.after) += score;
    joint.cost_J += score.cost_J(price_W);
  }
  PathScore turn(const ChainLeg& leg, const Pose& place, double payload_kg, double from_rad,
                 double to_rad) const {
    if (!request_.turns_count) return {.drivable = true};
    if (request_.may_turn && !request_.may_turn(place, from_rad, to_rad)) return {};
    return leg.turns->turn(from_rad, to_rad, payload_kg);
  }

  Joint from_start(const Way& after) const {
    Joint joint;
    if (!request_.start_heading_free) depart(0, request_.start, request_.start.heading_rad, after, joint);
    return joint;
  }
  /// The joint at the end of a leg whose station names a heading, or of the last leg.
  Joint arrival(const ChainLeg& leg, const Way& way) const {
    Joint joint{.heading_rad = leg.goal_heading_rad};
    if (leg.goal_heading_rad)
      charge(joint, turn(leg, leg.goal, leg.goal_payload_kg, way.arrives_rad, *leg.goal_heading_rad),
             leg.price_W, true);
    return joint;
  }
  void depart(std::size_t leg, const Pose& place, double from_rad, const Way& way, Joint& joint) const {
    const ChainLeg& here = request_.legs[leg];
    charge(joint, turn(here, place, here.start_payload_kg, from_rad, way.leaves_rad), here.price_W, false);
  }
  Joint free_stop(std::size_t leg, const Way& before, const Way& after) const {
    const ChainLeg &earlier = request_.legs[leg - 1], &later = request_.legs[leg];
    Joint at_end{.heading_rad = after.leaves_rad}, at_start;
    charge(at_end, turn(earlier, earlier.goal, earlier.goal_payload_kg, before.arrives_rad, after.leaves_rad),
           earlier.price_W, true);
    charge(at_start, turn(later, earlier.goal, later.start_payload_kg, before.arrives_rad, after.leaves_rad),
           later.price_W, false);
    return at_end.cost_J < at_start.cost_J ? at_end : at_start;
  }

  const ChainRequest& request_;
};

/// Least cost up to and including a way, and the way of the previous leg.
struct State {
  double cost_J{kNoLimit};
  std::size_t from{kNone};
};

std::vector<ChainChoice> choices_of(const ChainRequest& request, const Chain& chain,
                                    const std::vector<std::size_t>& way) {
  std::vector<ChainChoice> choices(way.size());
  const auto chosen = [&](std::size_t leg) { return &(*request.legs[leg].ways)[way[leg]]; };
  for (std::size_t leg = 0; leg <= way.size(); ++leg) {
    const Joint joint =
        chain.joint(leg, leg > 0 ? chosen(leg - 1) : nullptr, leg < way.size() ? chosen(leg) : nullptr);
    if (leg > 0) {
      choices[leg - 1].score += joint.before;
      choices[leg - 1].goal_heading_rad = joint.heading_rad;
    }
    if (leg == way.size()) break;
    choices[leg].way = way[leg];
    choices[leg].score = chosen(leg)->score;
    choices[leg].score += joint.after;
  }
  return choices;
}

}  // namespace

std::vector<ChainChoice> cheapest_chain(const ChainRequest& request,
                                        const std::function<bool(std::size_t leg, const Way&)>& usable) {
  const Chain chain(request);
  const std::size_t count = request.legs.size();
  std::vector<std::vector<State>> states(count);
  for (std::size_t leg = 0; leg < count; ++leg) {
    const std::vector<Way>& ways = *request.legs[leg].ways;
    states[leg].resize(ways.size());
    for (std::size_t to = 0; to < ways.size(); ++to) {
      if (!usable(leg, ways[to])) continue;
      const double own_J = ways[to].score.cost_J(request.legs[leg].price_W);
      State& state = states[leg][to];
      if (leg == 0) {
        state = {own_J + chain.joint(0, nullptr, &ways[to]).cost_J, kNone};
        continue;
      }
      for (std::size_t from = 0; from < states[leg - 1].size(); ++from) {
        const double before_J = states[leg - 1][from].cost_J;
        if (!(before_J + own_J < state.cost_J)) continue;
        const double sum_J =
            before_J + own_J + chain.joint(leg, &(*request.legs[leg - 1].ways)[from], &ways[to]).cost_J;
        if (sum_J < state.cost_J) state = {sum_J, from};
      }
    }
  }
  std::size_t last = kNone;
  double least_J = kNoLimit;
  for (std::size_t k = 0; k < states.back().size(); ++k) {
    if (!(states.back()[k].cost_J < least_J)) continue;
    const double sum_J =
        states.back()[k].cost_J + chain.joint(count, &(*request.legs.back().ways)[k], nullptr).cost_J;
    if (sum_J < least_J) least_J = sum_J, last = k;
  }
  if (last == kNone) return {};
  std::vector<std::size_t> way(count);
  for (std::size_t leg = count; leg-- > 0; last = states[leg][last].from) way[leg] = last;
  return choices_of(request, chain, way);
}

std::vector<PathScore> scores_between(const ChainRequest& request, const std::vector<ChainChoice>& chosen,
                                      std::size_t leg) {
  const Chain chain(request);
  const auto way = [&](std::size_t k) { return &(*request.legs[k].ways)[chosen[k].way]; };
  std::vector<PathScore> scores;
  for (const Way& tried : *request.legs[leg].ways) {
    PathScore score = tried.score;
    const Joint from = chain.joint(leg, leg > 0 ? way(leg - 1) : nullptr, &tried);
    const Joint to = chain.joint(leg + 1, &tried, leg + 1 < request.legs.size() ? way(leg + 1) : nullptr);
    for (const PathScore* turn : {&from.before, &from.after, &to.before, &to.after}) score += *turn;
    scores.push_back(score);
  }
  return scores;
}

}  // namespace joulepath
