#pragma once

#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath {

/// Samples for which a channel holds each of its readings; 1: every sample may be a reading, as of a channel
/// that is rounded to steps.
[[nodiscard]] std::size_t hold_of(const std::vector<double>& channel);

/// The dataset with lines between the readings of channels that hold them, in logs and in predictions: a
/// reading held is late by a part of the hold, which differs from channel to channel. A payload and commands
/// change in steps and stay.
[[nodiscard]] Dataset between_readings(Dataset dataset);

/// Whether any channel of any run holds its readings.
[[nodiscard]] bool holds_readings(const Dataset& dataset);

}  // namespace joulepath
