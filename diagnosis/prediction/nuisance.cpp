#include "diagnosis/prediction/nuisance.hpp"

#include <algorithm>
#include <array>

#include "model/effects/yardsticks.hpp"

namespace joulepath {
namespace {

constexpr std::array kColumnsOnly{&kSwingNuisance,      &kYawSwingNuisance,  &kStampNuisance,
                                  &kGyroStampNuisance,  &kPoseStampNuisance, &kBatteryStampNuisance,
                                  &kBatteryMeanNuisance};

}  // namespace

double usual_held_moment_Nm(const Robot& robot) {
  return kUsualHeldMoment * robot_measures::resisting_moment_Nm(robot);
}

bool is_column_only(const Nuisance& nuisance) {
  return std::ranges::any_of(kColumnsOnly, [&](const std::string* key) { return *key == nuisance.key; });
}

bool is_factor(const Nuisance& nuisance) {
  return nuisance.key != kCreepNuisance && nuisance.key != kHeldTurnNuisance && !is_column_only(nuisance);
}

std::string text_of(const Nuisance& nuisance) {
  return nuisance.side ? nuisance.key + " (" + side_name(*nuisance.side) + ")" : nuisance.key;
}

std::vector<Nuisance> calibration_nuisances(const Robot& robot) {
  std::vector<Nuisance> nuisances = nuisances_of(robot);
  nuisances.push_back({kCreepNuisance, std::nullopt, 1.0});
  for (const std::string* key : kColumnsOnly) nuisances.push_back({*key, std::nullopt, 1.0});
  for (Side side : kSides) nuisances.push_back({kHeldTurnNuisance, side, 1.0});
  return nuisances;
}

}  // namespace joulepath
