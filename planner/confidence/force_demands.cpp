#include "planner/confidence/force_demands.hpp"

#include <algorithm>
#include <cmath>

#include "planner/legs/leg_motion.hpp"
#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

constexpr double kReach = 6.0;  ///< of the sum of all one-sigma effects: what a place may come to

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

const std::vector<ForceDemands::Row>& ForceDemands::rows() {
  static const std::vector<Row> all = [] {
    std::vector<Row> rows;
    for (std::size_t i = 0; i < kForceLimits; ++i)
      for (const Side side : kSides)
        if (side == Side::left || force_limits()[i]->per_wheel) rows.push_back({i, side});
    return rows;
  }();
  return all;
}

ForceDemands::ForceDemands(const Plan& plan, const Robot& robot, const Plant& plant,
                           const ShiftedPlants& shifted)
    : plan_(plan), plant_(plant), linear_(rows().size()) {
  for (const LegPlan& leg : plan.legs)
    limits_.push_back(limits_between_payloads(robot, leg.payload.from_kg, leg.payload.to_kg));
  std::vector<std::vector<Place>> on_leg(plan.legs.size());
  for (Place& place : all_places()) on_leg[place.leg].push_back(std::move(place));
  for (std::size_t leg = 0; leg < on_leg.size(); ++leg)
    if (!on_leg[leg].empty()) linearize(leg, shifted, on_leg[leg]);
}

Limits ForceDemands::limits_on(std::size_t leg, const Plant& plant) const {
  Limits limits = limits_[leg];
  limit_by_battery(limits, plant.robot.battery);
  return limits;
}

std::vector<ForceDemands::Place> ForceDemands::all_places() const {
  constexpr std::array<double, 3> kShares{1e-7, 0.5, 1 - 1e-7};  // of a segment's time
  std::vector<Place> places;
  std::size_t count = 0;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    const LegPlan& leg = plan_.legs[k];
    const LegMotion motion(leg, plant_);
    for (std::size_t i = 0; i < leg.stretches.size(); ++i, ++count) {
      const Profile& profile = leg.stretches[i].profile;
      const bool travels = !is_turn(leg.stretches[i].request.piece);
      for (std::size_t n = 0; n + 1 < profile.time_s.size(); ++n)
        for (const double share : kShares) {
          const ProfileState state =
              profile.at_time(profile.time_s[n] + share * (profile.time_s[n + 1] - profile.time_s[n]));
          const MotionInstant instant = motion_instant(motion.stretch(i), state);
          places.push_back({k, count, instant.motion, instant.site, travels ? state.acceleration : 0.0});
        }
    }
    if (leg.prescribed)
      motion.integrate([&](const EnergyNode& node) {
        places.push_back({k, count, node.instant.motion, node.instant.site});
      });
    if (leg.prescribed) ++count;
  }
  return places;
}

double ForceDemands::use_of(const Row& row, const LimitState& state, const Limits& limits) {
  const Limit& limit = *force_limits()[row.limit];
  const double most = limit_of(limit, limits, state.plant.robot.motor, row.side);
  return most < kNoLimit ? limit_fraction(limit.value(state, row.side), most) : 0.0;
}

Eigen::MatrixXd ForceDemands::uses_by(const Plant& plant, std::size_t leg,
                                      const std::vector<Place>& places) const {
  const Plant here = plant_in(plant, plan_.legs[leg].state);
  const Limits limits = limits_on(leg, here);
  Eigen::MatrixXd uses(rows().size(), places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const LimitState state = state_at(places[k], here);
    for (std::size_t r = 0; r < rows().size(); ++r)
      uses(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(k)) = use_of(rows()[r], state, limits);
  }
  return uses;
}

void ForceDemands::linearize(std::size_t leg, const ShiftedPlants& shifted,
                             const std::vector<Place>& places) {
  const Eigen::MatrixXd use = uses_by(plant_, leg, places);
  std::vector<Eigen::MatrixXd> slopes;
  for (const auto& [more, less] : shifted)
    slopes.emplace_back(0.5 * (uses_by(more, leg, places) - uses_by(less, leg, places)));
  const std::size_t first = places_.size();
  places_.insert(places_.end(), places.begin(), places.end());
  for (std::size_t r = 0; r < rows().size(); ++r) {
    double& most = nominal_[rows()[r].limit];
    most = std::max(most, use.row(static_cast<Eigen::Index>(r)).maxCoeff());
    append_critical(r, first, use, slopes);
  }
}

void ForceDemands::append_critical(std::size_t row, std::size_t first_place, const Eigen::MatrixXd& use,
                                   const std::vector<Eigen::MatrixXd>& slopes) {
  const auto r = static_cast<Eigen::Index>(row);
  const auto reach = [&](Eigen::Index k) {
    double sum = 0;
    for (const Eigen::MatrixXd& slope : slopes) sum += std::abs(slope(r, k));
    return kReach * sum;
  };
  Linear& linear = linear_[row];
  std::vector<Eigen::Index> critical;
  for (Eigen::Index k = 0; k < use.cols(); ++k)
    if (!(use(r, k) + reach(k) < 1)) critical.push_back(k);
  Eigen::Index at = linear.use.size();
  linear.use.conservativeResize(at + static_cast<Eigen::Index>(critical.size()));
  linear.slope.conservativeResize(linear.use.size(), static_cast<Eigen::Index>(slopes.size()));
  for (const Eigen::Index k : critical) {
    linear.place.push_back(first_place + static_cast<std::size_t>(k));
    linear.use[at] = use(r, k);
    for (std::size_t e = 0; e < slopes.size(); ++e)
      linear.slope(at, static_cast<Eigen::Index>(e)) = slopes[e](r, k);
    ++at;
  }
}

ForceUses ForceDemands::estimate(const Eigen::VectorXd& sigmas) const {
  ForceUses uses{};
  for (std::size_t r = 0; r < rows().size(); ++r)
    if (linear_[r].use.size() > 0) {
      double& most = uses[rows()[r].limit];
      most = std::max(most, (linear_[r].use + linear_[r].slope * sigmas).maxCoeff());
    }
  return uses;
}

void ForceDemands::append_greatest(std::size_t row, const Eigen::VectorXd& sigmas,
                                   std::vector<std::size_t>& places) const {
  constexpr std::size_t kTop = 3;
  const Linear& linear = linear_[row];
  if (linear.use.size() == 0) return;
  const Eigen::VectorXd use = linear.use + linear.slope * sigmas;
  std::array<std::size_t, kTop> top{};
  std::size_t count = 0;
  const auto value = [&](std::size_t k) { return use[static_cast<Eigen::Index>(k)]; };
  for (std::size_t k = 0; k < linear.place.size(); ++k) {
    std::size_t at = count < kTop ? count++ : kTop;
    for (; at > 0 && value(k) > value(top[at - 1]); --at)
      if (at < kTop) top[at] = top[at - 1];
    if (at < kTop) top[at] = k;
    const bool ends = k + 1 == linear.place.size() ||
                      places_[linear.place[k + 1]].stretch != places_[linear.place[k]].stretch;
    for (std::size_t i = 0; ends && i < count; ++i) places.push_back(linear.place[top[i]]);
    if (ends) count = 0;
  }
}

ForceUses ForceDemands::of(const Plant& plant, const Eigen::VectorXd& sigmas) const {
  std::vector<std::size_t> places;
  for (std::size_t r = 0; r < rows().size(); ++r) append_greatest(r, sigmas, places);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  ForceUses uses{};
  for (std::size_t i = 0; i < places.size();) {
    const std::size_t leg = places_[places[i]].leg;
    const Plant here = plant_in(plant, plan_.legs[leg].state);
    const Limits limits = limits_on(leg, here);
    for (; i < places.size() && places_[places[i]].leg == leg; ++i) {
      const LimitState state = state_at(places_[places[i]], here);
      for (const Row& row : rows()) {
        double& most = uses[row.limit];
        most = std::max(most, use_of(row, state, limits));
      }
    }
  }
  return uses;
}

}  // namespace joulepath
