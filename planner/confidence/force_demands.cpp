#include "planner/confidence/force_demands.hpp"

#include <algorithm>
#include <cmath>

#include "planner/legs/leg_motion.hpp"
#include "planner/legs/stretch.hpp"

namespace joulepath {
namespace {

constexpr double kSmallUse = 0.05;  ///< to which a change is relative at least
constexpr double kSmallChange = 1e-6;
constexpr double kCrossing = 1.3;  ///< of the nominal use, the mean of both sides: the force changes its sign

/// Changes with one sigma, from the uses (>= 0) with one sigma more and one less. Where the force changes its
/// sign, the use falls and rises again: the change is that of the force.
double change_of(double use, double more, double less) {
  const double half = 0.5 * (more - less), mean = 0.5 * (more + less);
  return mean > kCrossing * use + kSmallChange ? std::copysign(mean, half) : half;
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

ForceDemands::ForceDemands(const Plan& plan, const Robot& robot, const DrawnPlant& nominal,
                           const ErrorPlants& errors)
    : plan_(plan), linear_(rows().size()) {
  for (const LegPlan& leg : plan.legs)
    limits_.push_back(limits_between_payloads(robot, leg.payload.from_kg, leg.payload.to_kg));
  std::vector<std::vector<Place>> on_leg(plan.legs.size());
  for (const Place& place : all_places(nominal.plant)) on_leg[place.leg].push_back(place);
  for (std::size_t leg = 0; leg < on_leg.size(); ++leg)
    if (!on_leg[leg].empty()) linearize(leg, nominal, errors, on_leg[leg]);
}

Limits ForceDemands::limits_on(std::size_t leg, const Plant& plant) const {
  Limits limits = limits_[leg];
  limit_by_battery(limits, plant.robot.battery);
  return limits;
}

std::vector<ForceDemands::Place> ForceDemands::all_places(const Plant& plant) const {
  constexpr std::array<double, 3> kShares{1e-7, 0.5, 1 - 1e-7};  // of a segment's time
  std::vector<Place> places;
  std::size_t count = 0;
  for (std::size_t k = 0; k < plan_.legs.size(); ++k) {
    const LegPlan& leg = plan_.legs[k];
    const LegMotion motion(leg, plant);
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
      motion.integrate([&](const EnergyNode& node, double) {
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

Eigen::MatrixXd ForceDemands::uses_by(const DrawnPlant& plant, std::size_t leg,
                                      const std::vector<Place>& places) const {
  const Plant here = plant.on(plan_.legs[leg], leg);
  const Limits limits = limits_on(leg, here);
  Eigen::MatrixXd uses(rows().size(), places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const LimitState state = state_at(places[k], here);
    for (std::size_t r = 0; r < rows().size(); ++r)
      uses(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(k)) = use_of(rows()[r], state, limits);
  }
  return uses;
}

void ForceDemands::linearize(std::size_t leg, const DrawnPlant& nominal, const ErrorPlants& errors,
                             const std::vector<Place>& places) {
  const Eigen::MatrixXd use = uses_by(nominal, leg, places);
  std::vector<std::array<Eigen::MatrixXd, 2>> near, far;
  for (const auto& [more, less] : errors.near)
    near.push_back({uses_by(more, leg, places), uses_by(less, leg, places)});
  for (const auto& [more, less] : errors.far)
    far.push_back({uses_by(more, leg, places), uses_by(less, leg, places)});
  const std::size_t first = places_.size();
  places_.insert(places_.end(), places.begin(), places.end());
  for (std::size_t i = 0; i < rows().size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    double& most = nominal_[rows()[i].limit];
    most = std::max(most, use.row(row).maxCoeff());
    Uses uses{.nominal = use.row(row).transpose(),
              .slope = Eigen::MatrixXd(use.cols(), std::ssize(near)),
              .far = Eigen::MatrixXd(use.cols(), 2 * std::ssize(far))};
    for (std::size_t e = 0; e < near.size(); ++e) {
      const auto column = static_cast<Eigen::Index>(e);
      const bool two_sided = e + errors.one_sided < near.size();
      for (Eigen::Index k = 0; k < use.cols(); ++k) {
        const double more = near[e][0](row, k), less = near[e][1](row, k);
        uses.slope(k, column) = two_sided ? change_of(uses.nominal[k], more, less) : 0.5 * (more - less);
      }
      for (const Eigen::Index side : {0, 1})
        uses.far.col(2 * column + side) = far[e][static_cast<std::size_t>(side)].row(row).transpose();
    }
    append_critical(linear_[i], first, uses, errors.factor);
  }
}

void ForceDemands::append_critical(Linear& linear, std::size_t first_place, const Uses& uses,
                                   const Eigen::MatrixXd& factor) {
  const Eigen::VectorXd& use = uses.nominal;
  const Eigen::MatrixXd drawn = uses.slope * factor;
  const auto stretch = [&](Eigen::Index k) {
    return places_[first_place + static_cast<std::size_t>(k)].stretch;
  };
  const auto may_saturate = [&](Eigen::Index k) {
    double growth = 1;
    for (Eigen::Index e = 0; e < uses.far.cols(); e += 2) {
      const double most = uses.far.row(k).segment(e, 2).maxCoeff<Eigen::PropagateNaN>();
      growth *= 1 + std::max(most - use[k], 0.0) / (use[k] + kSmallUse);
    }
    return !(growth * (use[k] + kSmallUse) < 1);  // a use that is no number is looked at, too
  };
  const auto is_below = [&](Eigen::Index k, Eigen::Index other) {
    return stretch(k) == stretch(other) &&
           use[other] - use[k] >= kReach * (drawn.row(other) - drawn.row(k)).norm() &&
           (uses.far.row(k).array() <= uses.far.row(other).array()).all();
  };
  std::vector<Eigen::Index> critical;
  for (Eigen::Index k = 0; k < use.size(); ++k) {
    if (!may_saturate(k)) continue;
    if (!critical.empty() && is_below(k, critical.back())) continue;
    while (!critical.empty() && is_below(critical.back(), k)) critical.pop_back();
    critical.push_back(k);
  }
  const auto add = [&](Eigen::Index k, double sign) {
    const Eigen::Index at = linear.use.size();
    linear.use.conservativeResize(at + 1);
    linear.slope.conservativeResize(at + 1, uses.slope.cols());
    linear.use[at] = sign * use[k];
    linear.slope.row(at) = sign * uses.slope.row(k);
    if (linear.place.empty() || places_[linear.place.back()].stretch != stretch(k))
      linear.stretch_end.emplace_back();
    linear.place.push_back(first_place + static_cast<std::size_t>(k));
    linear.stretch_end.back() = at + 1;
  };
  for (const Eigen::Index k : critical) {
    add(k, 1);
    if (kReach * drawn.row(k).norm() > 2 * use[k]) add(k, -1);
  }
}

std::vector<ForceUses> ForceDemands::estimate(const Eigen::MatrixXd& errors) const {
  std::vector<ForceUses> uses(static_cast<std::size_t>(errors.cols()), ForceUses{});
  for (std::size_t r = 0; r < rows().size(); ++r) {
    if (linear_[r].place.empty()) continue;
    const Eigen::VectorXd greatest = linear_[r].at(errors).colwise().maxCoeff();
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

ForceUses ForceDemands::uses_at(const std::vector<std::size_t>& places, const DrawnPlant& plant) const {
  ForceUses uses{};
  for (std::size_t i = 0; i < places.size();) {
    const std::size_t leg = places_[places[i]].leg;
    const Plant here = plant.on(plan_.legs[leg], leg);
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

std::vector<ForceUses> ForceDemands::of(const std::vector<DrawnPlant>& plants,
                                        const Eigen::MatrixXd& errors) const {
  std::vector<std::vector<std::size_t>> places(plants.size());
  for (const Linear& linear : linear_) {
    if (linear.place.empty()) continue;
    const Eigen::MatrixXd use = linear.at(errors);
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
