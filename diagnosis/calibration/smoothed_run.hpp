#pragma once

#include <string>
#include <vector>

#include "diagnosis/calibration/spline_kernel.hpp"
#include "diagnosis/values/dataset.hpp"

namespace joulepath::calibration {

/// One instant of a log, every channel smoothed by the same kernel.
struct SmoothedSample {
  double time_s{};
  Sided<double> speed_rad_s{};
  Sided<double> acceleration_rad_s2{};
  Sided<double> current_A{};
  Sided<double> current_slope_A_s{};
  Sided<double> voltage_V{};  ///< NaN where the log has none
  double payload_kg{};
  Sided<bool> turning{};  ///< the wheel turns one way throughout the kernel's reach
};

struct SmoothedRun {
  std::string name{};
  bool has_voltage{};
  bool unsigned_currents{};  ///< their signs were taken from the motion: braking samples are left out
  SplineKernel kernel{};
  double speed_noise_rad_s{};  ///< of raw samples, white: for taking its share out of the normal equations
  std::vector<SmoothedSample> samples{};
};

/// Smooths the runs of a dataset that carry wheel speeds (or v and omega) and both motor currents: even time
/// steps (linear interpolation where a log's are not), cut at gaps. Runs without them are left out.
[[nodiscard]] std::vector<SmoothedRun> smooth_runs(const Dataset& dataset);

}  // namespace joulepath::calibration
