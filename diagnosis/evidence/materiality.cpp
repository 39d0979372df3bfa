#include "diagnosis/evidence/materiality.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/numerics/parallel.hpp"
#include "diagnosis/prediction/rows.hpp"

namespace joulepath {
namespace {

double distance_m(const RunSignals& run, const Geometry& geometry) {
  double sum = 0;
  for (Side side : kSides)
    sum += 0.5 * geometry.wheel_radius_m[side] * run.wheel_speed_rad_s[side].cwiseAbs().sum() * run.period_s;
  return sum;
}

struct Sums {
  double motor_change{}, motor{}, battery_change{}, battery{};
  Impact impact{};
};

Sums sums_of(const RunSignals& run, const Prediction& with_it, const Prediction& without_it,
             const Geometry& geometry) {
  Sums sums;
  const Eigen::Index last = run.size() - 1;
  for (Side side : kSides) {
    sums.motor_change += (with_it.power_W[side] - without_it.power_W[side]).cwiseAbs().sum();
    sums.motor += without_it.power_W[side].cwiseAbs().sum();
  }
  if (run.battery_power_W.size() > 0) {
    sums.battery_change = (with_it.battery_power_W - without_it.battery_power_W).cwiseAbs().sum();
    sums.battery = without_it.battery_power_W.cwiseAbs().sum();
  }
  if (run.battery_voltage_V.size() > 0)
    sums.impact.battery_voltage_V =
        (with_it.battery_voltage_V - without_it.battery_voltage_V).cwiseAbs().maxCoeff();
  if (last < 0) return sums;
  const double travelled_m = std::max(kLeastTravelled_m, distance_m(run, geometry));
  sums.impact.heading_rad = std::abs(with_it.heading_rad[last] - without_it.heading_rad[last]);
  sums.impact.position =
      std::hypot(with_it.x_m[last] - without_it.x_m[last], with_it.y_m[last] - without_it.y_m[last]) /
      travelled_m;
  return sums;
}

/// The change of one run's channels by rows of the linear problem, added to a prediction.
Sums sums_of(const RunSignals& run, const ModelPoint& point, const Prediction& base,
             const Eigen::MatrixXd& rows) {
  Prediction changed = base;
  for (Side side : kSides) {
    const int s = side == Side::left ? 0 : 1;
    const Eigen::VectorXd current_A = rows.col(kCurrentLeft + s);
    changed.current_A[side] += current_A;
    changed.voltage_V[side] +=
        rows.col(kWindingLeft + s) + base.reading_resistance_ohm[side].cwiseProduct(current_A);
    changed.power_W[side] += changed.voltage_V[side].cwiseProduct(changed.current_A[side]) -
                             base.voltage_V[side].cwiseProduct(base.current_A[side]);
  }
  for (Eigen::Index j = 0; j < changed.battery_power_W.size(); ++j)
    changed.battery_power_W[j] +=
        supply_W(run, point.robot.power, changed, j) - supply_W(run, point.robot.power, base, j);
  if (changed.battery_power_W.size() > 0) changed.battery_power_W += rows.col(kDriverPower);
  if (changed.battery_voltage_V.size() > 0) changed.battery_voltage_V += rows.col(kSupplyVoltage);
  const auto from_start = [&](Channel c) { return (rows.col(c).array() - rows(0, c)).matrix(); };
  changed.heading_rad += from_start(kHeading);
  changed.x_m += from_start(kPositionX), changed.y_m += from_start(kPositionY);
  return sums_of(run, changed, base, point.robot.geometry);
}

Impact total_of(const std::vector<Sums>& sums) {
  Sums total;
  for (const Sums& s : sums) {
    total.motor_change += s.motor_change, total.motor += s.motor;
    total.battery_change += s.battery_change, total.battery += s.battery;
    Impact& most = total.impact;
    most.battery_voltage_V = std::max(most.battery_voltage_V, s.impact.battery_voltage_V);
    most.heading_rad = std::max(most.heading_rad, s.impact.heading_rad);
    most.position = std::max(most.position, s.impact.position);
  }
  total.impact.motor_power = total.motor > 0 ? total.motor_change / total.motor : 0.0;
  total.impact.battery_power = total.battery > 0 ? total.battery_change / total.battery : 0.0;
  return total.impact;
}

}  // namespace

Impact impact_of_term(const std::vector<RunSignals>& signals, const ModelPoint& point,
                      const std::vector<int>& entries, const Eigen::VectorXd& strength) {
  const DictionaryLayout layout = lay_out(signals, point.robot);
  std::vector<Sums> sums(signals.size());
  parallel_for(signals.size(), [&](std::size_t r) {
    if (signals[r].size() == 0) return;
    const Prediction base = predict(signals[r], point);
    const std::vector<Eigen::MatrixXd> all = dictionary_rows(layout, signals[r], point.robot, base);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(signals[r].size(), kChannelCount);
    for (std::size_t k = 0; k < entries.size(); ++k)
      rows += strength[static_cast<Eigen::Index>(k)] * all[static_cast<std::size_t>(entries[k])];
    sums[r] = sums_of(signals[r], point, base, rows);
  });
  return total_of(sums);
}

Impact impact_between(const std::vector<RunSignals>& signals, const ModelPoint& with_effect,
                      const ModelPoint& without_effect) {
  std::vector<Sums> sums(signals.size());
  parallel_for(signals.size(), [&](std::size_t r) {
    sums[r] = sums_of(signals[r], predict(signals[r], with_effect), predict(signals[r], without_effect),
                      without_effect.robot.geometry);
  });
  return total_of(sums);
}

double materiality(const Impact& impact, const MaterialityFloor& floor) {
  return std::max({impact.motor_power / floor.motor_power, impact.battery_power / floor.battery_power,
                   impact.battery_voltage_V / floor.battery_voltage_V, impact.heading_rad / floor.heading_rad,
                   impact.position / floor.position, impact.delay_samples / floor.delay_samples});
}

std::vector<double> least_amplitudes(const std::vector<RunSignals>& signals, const Robot& robot,
                                     const std::vector<Nuisance>& nuisances, const ModelState& state,
                                     const std::vector<Candidate>& candidates,
                                     std::map<std::string, double>& known) {
  std::vector<double> least(candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const Candidate& candidate = candidates[c];
    std::string key = candidate.label();
    for (const auto& [name, value] : candidate.shape.parameters)
      key += ' ' + name + '=' + std::to_string(value);
    if (const auto found = known.find(key); found != known.end()) {
      least[c] = found->second;
      continue;
    }
    ModelState without = state;
    std::erase_if(without.effects,
                  [&](const ActiveEffect& e) { return e.candidate.label() == candidate.label(); });
    ModelState with_it = without;
    std::vector<double> amplitude(candidate.amplitude.size(), 0.0);
    amplitude[0] = candidate.step[0];
    with_it.effects.push_back({candidate, amplitude});
    Impact impact = impact_between(signals, model_point(robot, nuisances, with_it),
                                   model_point(robot, nuisances, without));
    if (candidate.effect().delays_channels && !signals.empty())
      impact.delay_samples = candidate.step[0] / signals.front().log_period_s;
    const double ratio = materiality(impact);
    least[c] = known[key] = ratio > 0 ? candidate.step[0] / ratio : 1e300;
  }
  return least;
}

}  // namespace joulepath
