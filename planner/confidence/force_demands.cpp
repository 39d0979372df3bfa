#include "planner/confidence/force_demands.hpp"

#include <algorithm>
#include <cmath>

#include "planner/legs/leg_motion.hpp"
#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

constexpr double kReach = 6.0;  ///< sigmas of a use, or of the difference of two, that no draw exceeds

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
                           const ShiftedPlants& shifted, const Eigen::MatrixXd& factor)
    : plan_(plan), plant_(plant), linear_(rows().size()) {
  for (const LegPlan& leg : plan.legs)
    limits_.push_back(limits_between_payloads(robot, leg.payload.from_kg, leg.payload.to_kg));
  std::vector<std::vector<Place>> on_leg(plan.legs.size());
  for (Place& place : all_places()) on_leg[place.leg].push_back(std::move(place));
  for (std::size_t leg = 0; leg < on_leg.size(); ++leg)
    if (!on_leg[leg].empty()) linearize(leg, shifted, factor, on_leg[leg]);
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

void ForceDemands::linearize(std::size_t leg, const ShiftedPlants& shifted, const Eigen::MatrixXd& factor,
                             const std::vector<Place>& places) {
  const Eigen::MatrixXd use = uses_by(plant_, leg, places);
  std::vector<Eigen::MatrixXd> slopes;
  for (const auto& [more, less] : shifted)
    slopes.emplace_back(0.5 * (uses_by(more, leg, places) - uses_by(less, leg, places)));
  const std::size_t first = places_.size();
  places_.insert(places_.end(), places.begin(), places.end());
  for (std::size_t i = 0; i < rows().size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double& most = nominal_[rows()[i].limit];
    most = std::max(most, use.row(row).maxCoeff());
    Eigen::MatrixXd slope(use.cols(), std::ssize(slopes));
    for (Eigen::Index e = 0; e < slope.cols(); ++e)
      slope.col(e) = slopes[static_cast<std::size_t>(e)].row(row).transpose();
    append_critical(linear_[i], first, use.row(row).transpose(), slope, factor);
  }
}

void ForceDemands::append_critical(Linear& linear, std::size_t first_place, const Eigen::VectorXd& use,
                                   const Eigen::MatrixXd& slope, const Eigen::MatrixXd& factor) {
  const Eigen::MatrixXd drawn = slope * factor;
  const auto stretch = [&](Eigen::Index k) {
    return places_[first_place + static_cast<std::size_t>(k)].stretch;
  };
  const auto is_below = [&](Eigen::Index k, Eigen::Index other) {
    return stretch(k) == stretch(other) &&
           use[other] - use[k] >= kReach * (drawn.row(other) - drawn.row(k)).norm();
  };
  std::vector<Eigen::Index> critical;
  for (Eigen::Index k = 0; k < use.size(); ++k) {
    if (use[k] + kReach * drawn.row(k).norm() < 1) continue;
    if (!critical.empty() && is_below(k, critical.back())) continue;
    while (!critical.empty() && is_below(critical.back(), k)) critical.pop_back();
    critical.push_back(k);
  }
  Eigen::Index at = linear.use.size();
  linear.use.conservativeResize(at + std::ssize(critical));
  linear.slope.conservativeResize(linear.use.size(), slope.cols());
  for (const Eigen::Index k : critical) {
    const bool is_new = linear.place.empty() || places_[linear.place.back()].stretch != stretch(k);
    if (is_new) linear.stretch_end.emplace_back();
    linear.place.push_back(first_place + static_cast<std::size_t>(k));
    linear.use[at] = use[k];
    linear.slope.row(at) = slope.row(k);
    linear.stretch_end.back() = ++at;
  }
}

std::vector<ForceUses> ForceDemands::estimate(const Eigen::MatrixXd& sigmas) const {
  std::vector<ForceUses> uses(static_cast<std::size_t>(sigmas.cols()), ForceUses{});
  for (std::size_t r = 0; r < rows().size(); ++r) {
    if (linear_[r].place.empty()) continue;
    const Eigen::VectorXd greatest = linear_[r].at(sigmas).colwise().maxCoeff();
    for (std::size_t draw = 0; draw < uses.size(); ++draw) {
      double& most = uses[draw][rows()[r].limit];
      most = std::max(most, greatest[static_cast<Eigen::Index>(draw)]);
    }
  }
  return uses;
}

void ForceDemands::append_greatest(const Linear& linear, const double* use,
                                   std::vector<std::size_t>& places) {
  constexpr std::size_t kTop = 3;
  Eigen::Index k = 0;
  for (const Eigen::Index end : linear.stretch_end) {
    std::array<Eigen::Index, kTop> top{};
    std::size_t count = 0;
    for (; k < end; ++k) {
      if (count == kTop && !(use[k] > use[top.back()])) continue;
      std::size_t at = count < kTop ? count++ : kTop - 1;
      for (; at > 0 && use[k] > use[top[at - 1]]; --at) top[at] = top[at - 1];
      top[at] = k;
    }
    for (std::size_t i = 0; i < count; ++i) places.push_back(linear.place[static_cast<std::size_t>(top[i])]);
  }
}

ForceUses ForceDemands::uses_at(const std::vector<std::size_t>& places, const Plant& plant) const {
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

std::vector<ForceUses> ForceDemands::of(const std::vector<Plant>& plants,
                                        const Eigen::MatrixXd& sigmas) const {
  std::vector<std::vector<std::size_t>> places(plants.size());
  for (const Linear& linear : linear_) {
    if (linear.place.empty()) continue;
    const Eigen::MatrixXd use = linear.at(sigmas);
    for (std::size_t draw = 0; draw < plants.size(); ++draw)
      append_greatest(linear, use.col(static_cast<Eigen::Index>(draw)).data(), places[draw]);
  }
  std::vector<ForceUses> uses;
  for (std::size_t draw = 0; draw < plants.size(); ++draw) {
    std::vector<std::size_t>& of_draw = places[draw];
    std::sort(of_draw.begin(), of_draw.end());
    of_draw.erase(std::unique(of_draw.begin(), of_draw.end()), of_draw.end());
    uses.push_back(uses_at(of_draw, plants[draw]));
  }
  return uses;
}

}  // namespace joulepath
