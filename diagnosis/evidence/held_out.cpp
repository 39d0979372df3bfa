#include "diagnosis/evidence/held_out.hpp"

#include "diagnosis/numerics/indices.hpp"

namespace joulepath {

std::vector<double> held_out_losses(const LogSet& validation, const Identification& id,
                                    const ModelState& state) {
  const Robot& robot = validation.dataset->robot;
  const std::vector<RunSignals> signals = read_signals(validation, channel_delay_s(state));
  const EquationOptions options{.whole_catalog = false,
                                .dictionary = false,
                                .noise = &id.equations.noise,
                                .run_variance = &id.equations.run_variance};
  // The residual of the rows alone is wanted: no group of columns is put back.
  const Equations equations = build_equations(signals, robot, id.nuisances, state, {}, options);
  Eigen::VectorXd at_state = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(equations.columns.size()));
  for (std::size_t k = 0; k < equations.columns.size(); ++k)
    at_state[static_cast<Eigen::Index>(k)] = equations.columns[k].current;
  std::vector<double> losses;
  for (const RunEquations& run : equations.runs) losses.push_back(run_loss(run, at_state));
  return losses;
}

ModelState refit_on_diagnosis(const LogSet& diagnosis, const Identification& id,
                              const std::vector<ActiveEffect>& effects, Refit* details, int iterations) {
  ModelState start{.nuisance_fraction = id.state.nuisance_fraction, .effects = effects};
  Refit fitted = refit(diagnosis, every(diagnosis.runs.size()), id.nuisances, start, id.equations.noise,
                       id.equations.run_variance, id.dispersion, iterations);
  if (details) *details = fitted;
  return fitted.state;
}

}  // namespace joulepath
