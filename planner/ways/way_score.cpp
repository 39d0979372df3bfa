#include "planner/ways/way_score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/legs/leg_timing.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/values/leg_state.hpp"
#include "planner/ways/way_fields.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kTurnNodes = 30;
constexpr double kHighestPrice_W = 1e6;
/// Upper bound of the cost of an arc, relative to a turn in place by the same angle.
constexpr double kCornerShare = 0.5;

PathScore score_stretches(std::vector<ProfileRequest> stretches, double price_W) {
  for (ProfileRequest& request : stretches) request.draft = true;
  LegTiming timing(std::move(stretches));
  const std::vector<ProfileResult>& results = timing.solve(price_W, SolverChoice::fast);
  PathScore score{.drivable = true};
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (!results[k].profile) return {};
    const double duration_s = results[k].profile->duration_s();
    const bool optimized = results[k].summary.solver != "forward_backward";
    score.energy_J +=
        optimized ? results[k].summary.counted_J
                  : energy_by_cause(path_motion(timing.stretches()[k]), *results[k].profile).total_J();
    score.duration_s += duration_s;
  }
  return score;
}

/// Steady power (W, standby included) of driving straight along `heading_rad` at a point.
double steady_power_W(const Plant& plant, double payload_kg, double speed_m_s, const Pose& pose) {
  const Site site = site_of(plant.robot.geometry, pose, payload_kg, speed_m_s, 0.0);
  return std::max(0.0, power_by_cause(plant, {.speed_m_s = speed_m_s}, site).total_W());
}

}  // namespace

double ChoiceContext::finite_price_W() const { return std::isfinite(price_W) ? price_W : kHighestPrice_W; }

PathScore& PathScore::operator+=(const PathScore& other) {
  energy_J += other.energy_J;
  duration_s += other.duration_s;
  drivable &= other.drivable;
  return *this;
}

PathScore score_path(const Path& path, const LegRequest& leg, std::size_t leg_index,
                     const ChoiceContext& context, std::size_t nodes) {
  PlanOptions options = context.options;
  options.nodes = std::min(options.nodes, nodes);
  std::vector<ProfileRequest> stretches =
      stretches_of(path, leg, leg_index, context.mission, context.world, context.plant, options);
  for (ProfileRequest& request : stretches)
    if (is_turn(request.piece)) request.nodes = std::min(request.nodes, kTurnNodes);
  return score_stretches(std::move(stretches), context.price_W);
}

bool is_drivable(const Path& path, const LegRequest& leg, std::size_t leg_index,
                 const ChoiceContext& context) {
  LegTiming timing(
      stretches_of(path, leg, leg_index, context.mission, context.world, context.plant, context.options),
      context.options.answers);
  const std::vector<ProfileResult>& results = timing.solve(context.price_W, SolverChoice::fast);
  return std::all_of(results.begin(), results.end(),
                     [](const ProfileResult& result) { return result.profile.has_value(); });
}

const TurnScores::Table& TurnScores::table(double payload_kg) {
  const auto [entry, fresh] = tables_.try_emplace(payload_kg);
  if (fresh)
    entry->second = remembered(
        context_.options.answers, "turns", [&] { return tabulate(payload_kg); }, payload_kg, context_.price_W,
        drifting_constants(context_.plant));
  return entry->second;
}

TurnScores::Table TurnScores::tabulate(double payload_kg) const {
  Table table{};
  LegRequest leg{.payload = {payload_kg, payload_kg}};
  PlanOptions options = context_.options;
  options.nodes = kTurnNodes;
  table[0].drivable = true;
  for (std::size_t i = 1; i <= kAngles; ++i) {
    const double share = static_cast<double>(i) / kAngles;
    const Path path{{TurnInPlace{{}, std::numbers::pi * share * share}}};
    table[i] = score_stretches(stretches_of(path, leg, context_.mission.legs.size(), context_.mission,
                                            context_.world, context_.plant, options),
                               context_.price_W);
  }
  return table;
}

PathScore TurnScores::turn(double from_rad, double to_rad, double payload_kg) {
  const double angle_rad = std::abs(wrapped_angle_rad(to_rad - from_rad));
  if (angle_rad < 1e-9) return {.drivable = true};
  const Table& scores = table(payload_kg);
  const double place = std::sqrt(angle_rad / std::numbers::pi) * kAngles;
  const auto i = std::min(static_cast<std::size_t>(place), kAngles - 1);
  const double t = place - static_cast<double>(i);
  const PathScore &a = scores[i], &b = scores[i + 1];
  return {.energy_J = (1 - t) * a.energy_J + t * b.energy_J,
          .duration_s = (1 - t) * a.duration_s + t * b.duration_s,
          .drivable = a.drivable && b.drivable};
}

TravelCost travel_cost(const LegRequest& leg, const ChoiceContext& context, TurnScores& turns) {
  const Plant& plant = context.plant;
  const double payload_kg = std::max(leg.payload.from_kg, leg.payload.to_kg);
  const double limit_m_s = limits_along(context.world.robot, leg.payload).speed_m_s;
  const double cruise_m_s = std::isfinite(limit_m_s) ? limit_m_s : 1.0;
  const std::optional<SpeedMask>& mask = context.world.speed_mask;
  const double price_W = std::min(context.finite_price_W(), 1e3);
  const auto rate = [&plant, &mask, payload_kg, cruise_m_s, price_W](double x_m, double y_m,
                                                                     double heading_rad) {
    double speed_m_s = cruise_m_s;
    if (mask)
      speed_m_s =
          std::min(speed_m_s, std::max(0.05, mask->speed_cap_m_s(x_m, y_m, cruise_m_s).value_or(cruise_m_s)));
    return (steady_power_W(plant, payload_kg, speed_m_s, {x_m, y_m, heading_rad}) + price_W) / speed_m_s;
  };
  // Lower bound for the whole floor: the robot at full speed, outside of every region of the floor, in the
  // cheapest of 16 headings (a slope).
  double least = rate(1e9, 1e9, 0.0);
  for (int k = 0; k < 16; ++k) least = std::min(least, rate(1e9, 1e9, std::numbers::pi / 8 * k));
  least = std::max(1e-3, 0.999 * least);
  const double quarter_J = turns.turn(0.0, 0.5 * std::numbers::pi, payload_kg).cost_J(price_W);
  const double per_rad_J =
      std::isfinite(quarter_J) ? kCornerShare * quarter_J / (0.5 * std::numbers::pi) : 0.0;
  if (plant.effects.empty() && !mask) return {.per_rad = per_rad_J / least};
  return {.rate = rate, .least_rate = least, .per_rad = per_rad_J};
}

}  // namespace joulepath
