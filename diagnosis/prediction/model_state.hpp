#pragma once

#include <vector>

#include "diagnosis/prediction/candidates.hpp"
#include "diagnosis/prediction/nuisance.hpp"

namespace joulepath {

/// An effect that is part of the model, with the values found for it.
struct ActiveEffect {
  Candidate candidate{};  ///< shape parameters are in candidate.shape
  std::vector<double> amplitude{};
};

/// Where the search stands: calibration constants as they seem to be, and the effects taken up.
struct ModelState {
  std::vector<double> nuisance_fraction{};  ///< one per Nuisance
  std::vector<ActiveEffect> effects{};
};

/// The electrical channels' delay in a state, s.
double channel_delay_s(const ModelState& state);

/// The model that logs are held against: a time shift is left out, as the signals are read shifted.
ModelPoint model_point(const Robot& robot, const std::vector<Nuisance>& nuisances, const ModelState& state);

/// The effects of a state as a robot file or a dataset file says them.
std::vector<EffectSetting> settings_of(const Robot& robot, const ModelState& state);

/// True for effects that change what a log shows rather than what the robot does.
bool is_instrument(const std::string& effect);

}  // namespace joulepath
