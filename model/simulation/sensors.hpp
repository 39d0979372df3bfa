#pragma once

#include <cstdint>
#include <vector>

#include "model/simulation/drive.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// Seed of a further run of a dataset, below 2^53: neighboring seeds of datasets share no run. The first run
/// has the dataset's own.
[[nodiscard]] std::uint64_t seed_of_run(std::uint64_t seed, std::uint64_t run);

/// Properties of the instruments. The default is ideal: exact means over the sample period (pose: the value
/// at its end), without noise. Noise is white and Gaussian, one sigma per sample.
struct SensorSettings {
  double sample_rate_Hz{50.0};
  double encoder_counts_per_revolution{};  ///< at the wheel; 0 = continuous
  double wheel_speed_noise_rad_s{};
  double voltage_noise_V{};
  double current_noise_A{};
  double current_resolution_A{};  ///< quantization, 0 = none
  double voltage_resolution_V{};
  double electrical_delay_s{};  ///< age of motor voltage and current readings
  double gyro_noise_rad_s{};
  double position_noise_m{};
  double heading_noise_rad{};
};

/// Typical sensors of small robots.
[[nodiscard]] SensorSettings typical_sensors();

/// The truth at the end of a sample period.
struct Snapshot {
  double time_s{};
  DriveState state{};
  Drive::Instant instant{};
  double command_speed_m_s{};
  double command_yaw_rate_rad_s{};
  double payload_kg{};  ///< as stated
};

/// The log of the instruments: a row for every snapshot except the first. Readings are means since the
/// previous snapshot. Instrument effects are not included, see distort_log().
[[nodiscard]] Trajectory read_sensors(const std::vector<Snapshot>& truth, const SensorSettings& settings,
                                      bool has_battery, std::uint64_t seed);

}  // namespace joulepath
