#include "model/energy.hpp"

namespace joulepath {

double EnergyByCause::motion_J() const {
  double sum_J = copper_J + coulomb_friction_J + viscous_friction_J + kinetic_J + not_recovered_J;
  for (const auto& [name, energy_J] : effects_J) sum_J += energy_J;
  return sum_J;
}

void EnergyByCause::add(const Plant& plant, const PowerByCause& watts, double duration_s) {
  copper_J += watts.copper_W * duration_s;
  coulomb_friction_J += watts.coulomb_friction_W * duration_s;
  viscous_friction_J += watts.viscous_friction_W * duration_s;
  kinetic_J += watts.kinetic_W * duration_s;
  not_recovered_J += watts.not_recovered_W * duration_s;
  standby_J += watts.standby_W * duration_s;
  for (std::size_t k = 0; k < watts.effect_W.size(); ++k) {
    const auto name =
        std::visit([](const auto& effect) { return std::string(effect.info.name); }, plant.effects[k]);
    effects_J[name] += watts.effect_W[k] * duration_s;
  }
}

EnergyByCause& EnergyByCause::operator+=(const EnergyByCause& other) {
  copper_J += other.copper_J;
  coulomb_friction_J += other.coulomb_friction_J;
  viscous_friction_J += other.viscous_friction_J;
  kinetic_J += other.kinetic_J;
  not_recovered_J += other.not_recovered_J;
  standby_J += other.standby_J;
  for (const auto& [name, energy_J] : other.effects_J) effects_J[name] += energy_J;
  return *this;
}

std::map<std::string, double> named_causes_J(const EnergyByCause& energy) {
  std::map<std::string, double> causes{{"copper", energy.copper_J},
                                       {"coulomb_friction", energy.coulomb_friction_J},
                                       {"viscous_friction", energy.viscous_friction_J},
                                       {"kinetic", energy.kinetic_J},
                                       {"not_recovered", energy.not_recovered_J},
                                       {"standby", energy.standby_J}};
  causes.insert(energy.effects_J.begin(), energy.effects_J.end());
  return causes;
}

}  // namespace joulepath
