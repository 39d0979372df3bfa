#include "diagnosis/next_run/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/evidence/linear_fit.hpp"
#include "diagnosis/numerics/indices.hpp"
#include "model/mean_power.hpp"

namespace joulepath {
namespace {

constexpr int kRefits = 2;  ///< Gauss-Newton steps; the effects are nearly linear in their amplitudes

bool has_label(const Identification& id, const Explanation& explanation, const std::string& label) {
  return std::ranges::any_of(explanation.candidates, [&](int c) {
    return id.equations.candidates[static_cast<std::size_t>(c)].label() == label;
  });
}

/// A delayed channel asks for reading the logs again: no run is proposed for it.
bool delays(const Identification& id, const Explanation& explanation) {
  return std::ranges::any_of(explanation.candidates, [&](int c) {
    return id.equations.candidates[static_cast<std::size_t>(c)].effect().delays_channels;
  });
}

/// The best explanation with a label and without the other ones.
const Explanation* explanation_with(const Identification& id, const std::string& label,
                                    const std::vector<std::string>& labels) {
  const auto fits = [&](const Explanation& e) {
    return has_label(id, e, label) && !delays(id, e) && std::ranges::none_of(labels, [&](const auto& other) {
             return other != label && has_label(id, e, other);
           });
  };
  const auto found = std::ranges::find_if(id.explanations, fits);
  return found == id.explanations.end() ? nullptr : &*found;
}

Equations equations_about(const Identification& id, const Robot& robot,
                          const std::vector<RunSignals>& signals, const ModelState& state,
                          Forms forms = Forms::active) {
  return build_equations(signals, robot, id.nuisances, state, {},
                         {.whole_catalog = false,
                          .dictionary = false,
                          .forms = forms,
                          .noise = &id.equations.noise,
                          .run_variance = &id.equations.run_variance});
}

/// A Gauss-Newton step. The laws are those of the catalog: a prediction has no other form.
ModelState refitted(const Identification& id, const Equations& equations, const ModelState& state) {
  Explanation own;
  for (std::size_t c = 0; c < state.effects.size(); ++c) {
    own.candidates.push_back(static_cast<int>(c));
    for (int k : equations.columns_of_candidate(static_cast<int>(c), true)) own.columns.push_back(k);
  }
  return adopt(equations, id.nuisances, state, own,
               fit_parameters(equations, every(equations.runs.size()), own.columns, id.dispersion));
}

std::vector<int> all_columns(const Equations& equations) {
  std::vector<int> columns;
  for (std::size_t k = 0; k < equations.columns.size(); ++k) columns.push_back(static_cast<int>(k));
  return columns;
}

double loss_of(const std::vector<RunEquations>& runs, const Equations& equations, double dispersion) {
  const LinearProblem problem = sum_runs(runs, every(runs.size()), equations.prior_sd);
  return solve(problem, all_columns(equations), dispersion, false).loss;
}

/// What the motors of a predicted run take and return.
SupplyAccount account_of_prediction(const Prediction& shown, PowerSharing sharing) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(shown.battery_power_W.size());
  SupplyAccount account{.draw_W = zero, .return_W = zero, .mixed_W = zero, .motor_W = shown.power_W};
  for (Eigen::Index j = 0; j < zero.size(); ++j) {
    const SupplyShares shares = supply_shares(sharing, {shown.power_W.left[j], shown.power_W.right[j]},
                                              {shown.power_change_W.left[j], shown.power_change_W.right[j]});
    account.draw_W[j] = shares.draw_W;
    account.return_W[j] = shares.return_W;
    account.mixed_W[j] = shares.mixed_W;
  }
  return account;
}

/// Whether any present run has a channel.
template <class Has>
bool any_run(const Identification& id, Has&& has) {
  return std::ranges::any_of(id.signals, has);
}

}  // namespace

std::vector<Rival> fitted_rivals(const Identification& id, const Robot& robot,
                                 const std::vector<std::string>& labels) {
  std::vector<Rival> rivals;
  const std::vector<std::size_t> runs = every(id.equations.runs.size());
  for (const std::string& label : labels) {
    const Explanation* e = explanation_with(id, label, labels);
    if (!e) continue;
    Rival rival{.label = label,
                .state = adopt(id.equations, id.nuisances, id.state, *e,
                               fit_parameters(id.equations, runs, e->columns, id.dispersion))};
    for (int step = 0; step < kRefits; ++step)
      rival.state =
          refitted(id, equations_about(id, robot, id.signals, rival.state, Forms::none), rival.state);
    rival.present = equations_about(id, robot, id.signals, rival.state);
    rival.loss = loss_of(rival.present.runs, rival.present, id.dispersion);
    rivals.push_back(std::move(rival));
  }
  return rivals;
}

RunSignals expected_signals(const Identification& id, const Robot& robot, RunSignals run,
                            const Rival& truth) {
  const auto n = run.size();
  run.battery_current_A.setZero(
      any_run(id, [](const RunSignals& r) { return r.battery_current_A.size() > 0; }) ? n : 0);
  Prediction shown = predict(run, model_point(robot, id.nuisances, truth.state));
  if (run.battery_current_A.size() > 0 && std::isfinite(robot.battery.open_circuit_voltage_V)) {
    run.battery_current_A = shown.battery_power_W / robot.battery.open_circuit_voltage_V;
    shown = predict(run, model_point(robot, id.nuisances, truth.state));
    run.battery_voltage_V = shown.battery_voltage_V;
  }
  if (any_run(id, [](const RunSignals& r) { return r.battery_power_W.size() > 0; }))
    run.battery_power_W = shown.battery_power_W;
  for (Side side : kSides) {
    if (any_run(id, [&](const RunSignals& r) { return r.motor_current_A[side].size() > 0; }))
      run.motor_current_A[side] = shown.current_A[side], run.current_direction[side] = {};
    if (any_run(id, [&](const RunSignals& r) { return r.motor_voltage_V[side].size() > 0; }))
      run.motor_voltage_V[side] = shown.voltage_V[side];
    if (any_run(id, [&](const RunSignals& r) { return r.motor_power_W[side].size() > 0; }))
      run.motor_power_W[side] = shown.power_W[side];
  }
  if (measures_motors(run)) run.motors_at_supply = account_of_prediction(shown, robot.power.sharing);
  mark_conducting(run, robot);
  if (any_run(id, [](const RunSignals& r) { return r.gyro_yaw_rate_rad_s.size() > 0; }))
    run.gyro_yaw_rate_rad_s = shown.yaw_rate_rad_s;
  run.heading_measured = any_run(id, [](const RunSignals& r) { return r.heading_measured; });
  if (run.heading_measured) run.heading_rad = shown.heading_rad;
  const bool placed = any_run(id, [](const RunSignals& r) { return r.x_m.size() > 0; });
  run.x_m = placed ? shown.x_m : Eigen::VectorXd{};
  run.y_m = placed ? shown.y_m : Eigen::VectorXd{};
  return run;
}

double expected_ratio(const Identification& id, const Robot& robot, const RunSignals& shown,
                      const Rival& other) {
  const Equations further = equations_about(id, robot, {shown}, other.state);
  std::vector<RunEquations> runs = other.present.runs;
  runs.push_back(further.runs.front());
  return std::max(0.0, loss_of(runs, other.present, id.dispersion) - other.loss);
}

}  // namespace joulepath
