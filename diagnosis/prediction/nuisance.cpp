#include "diagnosis/prediction/nuisance.hpp"

namespace joulepath {

std::string text_of(const Nuisance& nuisance) {
  return nuisance.side ? nuisance.key + " (" + side_name(*nuisance.side) + ")" : nuisance.key;
}

std::vector<Nuisance> calibration_nuisances(const Robot& robot) {
  std::vector<Nuisance> nuisances = nuisances_of(robot);
  nuisances.push_back({kCreepNuisance, std::nullopt, 1.0});
  nuisances.push_back({kStampNuisance, std::nullopt, 1.0});
  return nuisances;
}

}  // namespace joulepath
