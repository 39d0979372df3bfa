#pragma once

#include <string>
#include <vector>

#include "plant.hpp"
#include "random.hpp"

namespace blind {

/// Standard deviations of the logged channels' noise and its colour.
struct SensorNoise {
  double wheel_speed_rad_s{0.015};
  double voltage_V{0.03};
  double current_A{0.015};
  double battery_voltage_V{0.02};
  double battery_current_A{0.01};
  double gyro_rad_s{0.003};
  double position_m{0.005};
  double heading_rad{0.003};
  double electrical_correlation{0.0};  ///< AR(1) of motor voltages and currents, from sample to sample
  double motion_correlation{0.0};      ///< AR(1) of wheel speeds and gyro
  int tail_freedom{0};                 ///< Student's t innovations with this many degrees; 0 = Gaussian
};

/// The sensor chain without noise: offsets, gains, delays, drifts of the world.
void distort(std::vector<Sample>& log, const World& world, double start_time_s);

/// Add noise (after `distort`).
void add_noise(std::vector<Sample>& log, const SensorNoise& noise, Random& random);

/// The run's CSV, each channel rounded to its sensor's resolution.
[[nodiscard]] std::string run_csv(const std::vector<Sample>& log);

}  // namespace blind
