#include "diagnosis/evidence/unstated_payload.hpp"

#include <algorithm>

#include "diagnosis/evidence/linear_fit.hpp"
#include "diagnosis/evidence/signatures.hpp"
#include "model/limit_table.hpp"
// Design: docs/decisions/0503-evidence.md
namespace joulepath {
namespace {

constexpr int kRounds = 3;  ///< the torque is linear in the payload but for losses that grow with the load

/// Places of the runs that choose and fit.
std::vector<std::size_t> fitted_places(const RunsByUse& runs) {
  std::vector<std::size_t> places;
  for (std::size_t r = 0; r < runs.signals.size(); ++r)
    if (std::ranges::count(runs.diagnosis.runs, runs.signals[r].run_index) > 0) places.push_back(r);
  return places;
}

/// One step: each unstated payload moves by what its run's equations leave.
void move_payloads(const Equations& equations, const std::vector<std::size_t>& fitted, const Robot& robot,
                   std::vector<RunSignals>& signals) {
  const Eigen::VectorXd parameters =
      fit_parameters(equations, fitted, equations.columns_of(Column::Kind::amplitude), 1.0);
  for (std::size_t r = 0; r < signals.size(); ++r) {
    if (signals[r].payload_known || signals[r].size() == 0) continue;
    const double change_kg = own_deviations(equations.runs[r], parameters).tail(1)[0];
    signals[r].payload_kg.setConstant(
        std::clamp(signals[r].payload_kg[0] + change_kg, 0.0, payload_limit_kg(robot)));
  }
}

}  // namespace

RunsByUse with_estimated_payloads(RunsByUse runs) {
  std::vector<RunSignals>& signals = runs.signals;
  if (std::ranges::all_of(signals, &RunSignals::payload_known)) return runs;
  const Robot& robot = runs.diagnosis.dataset->robot;
  const std::vector<Nuisance> nuisances = calibration_nuisances(robot);
  const ModelState nominal{.nuisance_fraction = std::vector<double>(nuisances.size(), 0.0)};
  const std::vector<std::size_t> fitted = fitted_places(runs);
  const Equations first = build_equations(signals, robot, nuisances, nominal, {}, {});
  move_payloads(first, fitted, robot, signals);
  for (int round = 1; round < kRounds; ++round)
    move_payloads(
        build_equations(signals, robot, nuisances, nominal, {},
                        {.dictionary = false, .noise = &first.noise, .run_variance = &first.run_variance}),
        fitted, robot, signals);
  for (const RunSignals& run : signals)
    if (!run.payload_known && run.size() > 0)
      for (LogSet* logs : {&runs.diagnosis, &runs.validation})
        logs->estimated_payload_kg[run.run_index] = run.payload_kg[0];
  return runs;
}

}  // namespace joulepath
