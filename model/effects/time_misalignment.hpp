#pragma once

#include <array>

#include "model/effects/effect.hpp"

namespace joulepath {

/// The electrical channels are late: they are stamped on arrival, or buffered.
struct TimeMisalignment {
  double delay_s{};

  static constexpr EffectInfo info{.name = "time_misalignment",
                                   .kind = "instruments",
                                   .stage = Stage::instrument,
                                   .law = "motor voltage and current channels show the value of delay_s ago",
                                   .validity = "logs only; delays shorter than the run",
                                   .source = "-",
                                   .gazebo = "sensor latency of the log",
                                   .mujoco = "sensor delay of the log",
                                   .needs = {.samples = true}};
  static constexpr auto parameters() {
    return std::array{EffectParameter<TimeMisalignment>{
        "delay_s", "s", -5, 5, 0.05, "age of the electrical readings", &TimeMisalignment::delay_s}};
  }

  double channel_delay_s() const { return delay_s; }
};

}  // namespace joulepath
