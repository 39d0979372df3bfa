#include "diagnosis/evidence/fitted_model.hpp"

#include "diagnosis/numerics/indices.hpp"

namespace joulepath {

Refit fit_effects(const LogSet& diagnosis, const Identification& id, const std::vector<ActiveEffect>& effects,
                  const std::set<std::string>& unknowns) {
  const ModelState start{.nuisance_fraction = id.state.nuisance_fraction, .effects = effects};
  return refit(diagnosis, every(diagnosis.runs.size()), id.nuisances, start, id.equations.noise,
               id.equations.run_variance, id.dispersion, unknowns);
}

}  // namespace joulepath
