#pragma once

#include <vector>

#include "diagnosis/prediction/candidates.hpp"
#include "diagnosis/prediction/nuisance.hpp"

namespace joulepath {

/// An effect of the model with its fitted values.
struct ActiveEffect {
  Candidate candidate{};  ///< includes the shape parameters
  std::vector<double> amplitude{};
};

/// State of the search: calibration constants and accepted effects.
struct ModelState {
  std::vector<double> nuisance_fraction{};  ///< one per Nuisance
  std::vector<ActiveEffect> effects{};
};

/// Delay of the electrical channels in a state, s.
double channel_delay_s(const ModelState& state);

/// The model of a state. The time shift is left out, because the signals are read with that shift.
ModelPoint model_point(const Robot& robot, const std::vector<Nuisance>& nuisances, const ModelState& state);

/// The effects of a state as written in a robot file or a dataset file.
std::vector<EffectSetting> settings_of(const Robot& robot, const ModelState& state);

/// True for effects that change the log and not the motion of the robot.
bool is_instrument(const std::string& effect);

}  // namespace joulepath
