#include "extensions/onboard/drift.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string_view>

namespace joulepath {
namespace {

constexpr double kPower = 0.8416;  ///< normal quantile of 80 %
/// These follow from the two inertias that are fitted.
constexpr std::array kFollowFromOthers{"wheel_axle_inertia_kg_m2", "chassis_yaw_inertia_kg_m2"};

/// What shows a constant, by the beginning of its name.
struct Shows {
  std::string_view name;
  const char* needs;
};
constexpr Shows kShows[] = {
    {"friction_torque", "drives at steady speed"},
    {"viscous_", "drives at a low and at a high steady speed"},
    {"straight_inertia", "straight drives with firm starts and stops"},
    {"turning_inertia", "turns in place with firm starts and stops"},
    {"payload_factor", "the same drives with and without payload"},
    {"torque_per_ampere", "motor voltages, and drives at a low and at a high speed"},
    {"resistance", "motor voltages, and starts with a high current"},
};

/// A day's estimate.
struct DayEstimate {
  double value{}, deviation{}, freedom{};
  std::size_t day{};
};

struct Statistic {
  double value{}, mean{}, error{};
  std::size_t from{};  ///< index of the first estimate behind the change
};

/// The first estimate is the reference.
Statistic largest_statistic(const std::vector<DayEstimate>& estimates) {
  Statistic best;
  double weight = 0, sum = 0;
  const DayEstimate& first = estimates.front();
  for (std::size_t k = estimates.size() - 1; k > 0; --k) {
    const double w = 1 / (estimates[k].deviation * estimates[k].deviation);
    weight += w;
    sum += w * estimates[k].value;
    const double error = std::sqrt(1 / weight + first.deviation * first.deviation);
    const double value = std::abs(sum / weight - first.value) / error;
    if (value >= best.value) best = {value, sum / weight, error, k};
  }
  return best;
}

/// The same days without a drift: values scatter by their deviations, and the estimated deviations as those
/// of `freedom` degrees of freedom.
double simulated_statistic(const std::vector<DayEstimate>& estimates, std::mt19937_64& random) {
  static thread_local std::vector<DayEstimate> drawn;
  drawn.assign(estimates.begin(), estimates.end());
  for (DayEstimate& estimate : drawn) {
    estimate.value = std::normal_distribution<double>(0.0, estimate.deviation)(random);
    const double chi2 = std::chi_squared_distribution<double>(estimate.freedom)(random);
    estimate.deviation *= std::sqrt(std::max(1e-12, chi2 / estimate.freedom));
  }
  return largest_statistic(drawn).value;
}

double threshold_of(const std::vector<DayEstimate>& estimates, double rate, const DriftSettings& settings) {
  std::mt19937_64 random(settings.seed);
  std::vector<double> drawn(settings.draws);
  for (double& value : drawn) value = simulated_statistic(estimates, random);
  const auto rank = static_cast<std::size_t>((1 - rate) * static_cast<double>(settings.draws));
  const auto at = drawn.begin() + static_cast<std::ptrdiff_t>(std::min(rank, settings.draws - 1));
  std::nth_element(drawn.begin(), at, drawn.end());
  return *at;
}

/// Whether a day's calibration determines a constant.
bool determined(const CalibratedParameter& p) {
  return p.visibility != Visibility::unseen && std::isfinite(p.standard_deviation) &&
         p.standard_deviation > 0;
}

std::vector<DayEstimate> estimates_of(const std::vector<std::vector<CalibratedParameter>>& days,
                                      const std::string& name) {
  std::vector<DayEstimate> estimates;
  for (std::size_t day = 0; day < days.size(); ++day)
    for (const CalibratedParameter& p : days[day])
      if (p.name == name && determined(p))
        estimates.push_back({p.value, p.standard_deviation, std::max(1.0, p.effective_runs - 1), day});
  return estimates;
}

NotCompared not_compared(const std::vector<std::vector<CalibratedParameter>>& days, const std::string& name) {
  NotCompared result{.name = name};
  for (const Shows& shows : kShows)
    if (name.starts_with(shows.name)) result.needs = shows.needs;
  for (const std::size_t day : {std::size_t{0}, days.size() - 1})
    for (const CalibratedParameter& p : days[day]) {
      if (p.name != name || determined(p)) continue;
      const bool unseen = p.visibility == Visibility::unseen;
      if (result.days.empty()) result.why = unseen ? p.note : "too few runs for an interval";
      if (!unseen) result.needs = "four runs or 40 s of driving";
      result.days.push_back(day);
    }
  return result;
}

ParameterDrift drift_of(const CalibratedParameter& parameter, const std::vector<DayEstimate>& estimates,
                        double threshold) {
  const Statistic found = largest_statistic(estimates);
  double weight = 0;
  for (std::size_t k = 1; k < estimates.size(); ++k)
    weight += 1 / (estimates[k].deviation * estimates[k].deviation);
  const double reference_s = estimates.front().deviation;
  return {.name = parameter.name,
          .unit = parameter.unit,
          .reference = estimates.front().value,
          .value = found.mean,
          .standard_error = found.error,
          .since = estimates[found.from].day,
          .days = estimates.size() - 1,
          .statistic = found.value,
          .threshold = threshold,
          .detectable = (threshold + kPower) * std::sqrt(1 / weight + reference_s * reference_s),
          .drifted = found.value > threshold};
}

}  // namespace

bool DriftResult::drifted() const {
  return std::ranges::any_of(parameters, [](const ParameterDrift& p) { return p.drifted; });
}

DriftResult find_drift(const std::vector<std::vector<CalibratedParameter>>& days,
                       const DriftSettings& settings) {
  DriftResult result;
  std::vector<const CalibratedParameter*> compared;
  std::vector<std::vector<DayEstimate>> all;
  for (const CalibratedParameter& parameter : days.front()) {
    if (std::ranges::count(kFollowFromOthers, parameter.name) > 0) continue;
    std::vector<DayEstimate> estimates = estimates_of(days, parameter.name);
    const bool counts =
        estimates.size() >= 2 && estimates.front().day == 0 && estimates.back().day + 1 == days.size();
    if (!counts) {
      result.not_compared.push_back(not_compared(days, parameter.name));
      continue;
    }
    compared.push_back(&parameter);
    all.push_back(std::move(estimates));
  }
  const double rate = 1 - std::pow(1 - settings.false_alarm_rate, 1 / std::max<double>(1, all.size()));
  for (std::size_t i = 0; i < all.size(); ++i)
    result.parameters.push_back(drift_of(*compared[i], all[i], threshold_of(all[i], rate, settings)));
  return result;
}

}  // namespace joulepath
