#include "planner/confidence/force_demands.hpp"

#include <algorithm>
#include <cmath>

#include "planner/legs/leg_motion.hpp"
#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

constexpr double kReach = 3.0;    ///< of the sum of all one-sigma effects: what a place may come to
constexpr Eigen::Index kTop = 4;  ///< places of a limit at which a drawn plant is evaluated

/// The places of the greatest values, at most kTop.
std::vector<Eigen::Index> greatest(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Eigen::Index>(i);
  const auto top = order.begin() + std::min<Eigen::Index>(kTop, values.size());
  std::partial_sort(order.begin(), top, order.end(),
                    [&](Eigen::Index a, Eigen::Index b) { return values[a] > values[b]; });
  order.erase(top, order.end());
  return order;
}

}  // namespace

const std::array<const Limit*, kForceLimits>& force_limits() {
  static const std::array<const Limit*, kForceLimits> limits = [] {
    std::array<const Limit*, kForceLimits> rows{};
    std::size_t count = 0;
    for (const Limit& row : kLimits)
      if (row.of_forces) rows[count++] = &row;
    return rows;
  }();
  return limits;
}

ForceDemands::ForceDemands(const Plan& plan, const Robot& robot, const Plant& plant,
                           const ShiftedPlants& shifted)
    : plan_(plan), plant_(plant) {
  for (const LegPlan& leg : plan.legs)
    limits_.push_back(limits_between_payloads(robot, leg.payload.from_kg, leg.payload.to_kg));
  std::vector<std::vector<Place>> on_leg(plan.legs.size());
  for (Place& place : all_places()) on_leg[place.leg].push_back(std::move(place));
  for (std::size_t leg = 0; leg < on_leg.size(); ++leg) linearize(leg, shifted, on_leg[leg]);
}

Limits ForceDemands::limits_on(std::size_t leg, const Plant& plant) const {
  Limits limits = limits_[leg];
  limit_by_battery(limits, plant.robot.battery);
  return limits;
}

void ForceDemands::append_stretch(std::size_t leg, const StretchPlan& stretch, const PathMotion& motion,
                                  std::vector<Place>& places) const {
  constexpr std::array<double, 3> kShares{1e-7, 0.5, 1 - 1e-7};  // of a segment's time
  const Profile& profile = stretch.profile;
  const bool travels = !is_turn(stretch.request.piece);
  for (std::size_t k = 0; k + 1 < profile.time_s.size(); ++k)
    for (const double share : kShares) {
      const double time_s = profile.time_s[k] + share * (profile.time_s[k + 1] - profile.time_s[k]);
      const ProfileState state = profile.at_time(time_s);
      const MotionInstant instant = motion_instant(motion, state);
      places.push_back({leg, instant.motion, instant.site, travels ? state.acceleration : 0.0});
    }
}

std::vector<ForceDemands::Place> ForceDemands::all_places() const {
  std::vector<Place> places;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    const LegPlan& leg = plan_.legs[k];
    const LegMotion motion(leg, plant_);
    for (std::size_t i = 0; i < leg.stretches.size(); ++i)
      append_stretch(k, leg.stretches[i], motion.stretch(i), places);
    if (leg.prescribed)
      motion.integrate([&](const EnergyNode& node) {
        places.push_back({.leg = k, .motion = node.instant.motion, .site = node.instant.site});
      });
  }
  return places;
}

ForceUses ForceDemands::uses_at(const Place& place, const Plant& plant, const Limits& limits) const {
  const LimitState state = limit_state(plant, place.motion, place.site, place.speed_gain_m_s2, 0.0);
  ForceUses uses{};
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const Limit& row = *force_limits()[i];
    for (const Side side : kSides) {
      if (side == Side::right && !row.per_wheel) break;
      const double limit = limit_of(row, limits, plant.robot.motor, side);
      if (limit < kNoLimit) uses[i] = std::max(uses[i], limit_fraction(row.value(state, side), limit));
    }
  }
  return uses;
}

Eigen::MatrixXd ForceDemands::uses_by(const Plant& plant, std::size_t leg,
                                      const std::vector<Place>& places) const {
  const Plant here = plant_in(plant, plan_.legs[leg].state);
  const Limits limits = limits_on(leg, here);
  Eigen::MatrixXd uses(kForceLimits, places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ForceUses at = uses_at(places[k], here, limits);
    for (std::size_t i = 0; i < at.size(); ++i)
      uses(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = at[i];
  }
  return uses;
}

void ForceDemands::linearize(std::size_t leg, const ShiftedPlants& shifted,
                             const std::vector<Place>& places) {
  if (places.empty()) return;
  const Eigen::MatrixXd use = uses_by(plant_, leg, places);
  std::vector<Eigen::MatrixXd> slopes;
  Eigen::MatrixXd reach = Eigen::MatrixXd::Zero(use.rows(), use.cols());
  for (const auto& [more, less] : shifted) {
    slopes.emplace_back(0.5 * (uses_by(more, leg, places) - uses_by(less, leg, places)));
    reach += slopes.back().cwiseAbs();
  }
  const std::size_t before = places_.size();
  places_.insert(places_.end(), places.begin(), places.end());
  for (Eigen::Index i = 0; i < use.rows(); ++i) {
    double& most = nominal_[static_cast<std::size_t>(i)];
    most = std::max(most, use.row(i).maxCoeff());
    Linear& linear = linear_[static_cast<std::size_t>(i)];
    std::vector<Eigen::Index> critical;
    for (Eigen::Index k = 0; k < use.cols(); ++k)
      if (!(use(i, k) + kReach * reach(i, k) < 1)) critical.push_back(k);
    const Eigen::Index old = linear.use.size(), count = old + static_cast<Eigen::Index>(critical.size());
    linear.use.conservativeResize(count);
    linear.slope.conservativeResize(count, static_cast<Eigen::Index>(slopes.size()));
    for (std::size_t c = 0; c < critical.size(); ++c) {
      const Eigen::Index row = old + static_cast<Eigen::Index>(c), k = critical[c];
      linear.place.push_back(before + static_cast<std::size_t>(k));
      linear.use[row] = use(i, k);
      for (std::size_t e = 0; e < slopes.size(); ++e)
        linear.slope(row, static_cast<Eigen::Index>(e)) = slopes[e](i, k);
    }
  }
}

ForceUses ForceDemands::estimate(const Eigen::VectorXd& sigmas) const {
  ForceUses uses{};
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (linear_[i].use.size() > 0) uses[i] = (linear_[i].use + linear_[i].slope * sigmas).maxCoeff();
  return uses;
}

ForceUses ForceDemands::of(const Plant& plant, const Eigen::VectorXd& sigmas) const {
  ForceUses uses{};
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (linear_[i].use.size() == 0) continue;
    for (const Eigen::Index top : greatest(linear_[i].use + linear_[i].slope * sigmas)) {
      const Place& place = places_[linear_[i].place[static_cast<std::size_t>(top)]];
      const Plant here = plant_in(plant, plan_.legs[place.leg].state);
      uses[i] = std::max(uses[i], uses_at(place, here, limits_on(place.leg, here))[i]);
    }
  }
  return uses;
}

}  // namespace joulepath
