#pragma once

#include <string>
#include <vector>

#include "diagnosis/calibration/spline_kernel.hpp"
#include "diagnosis/values/dataset.hpp"

namespace joulepath::calibration {

/// One instant of a log, with every channel smoothed by the same kernel.
struct SmoothedSample {
  double time_s{};
  Sided<double> speed_rad_s{};
  Sided<double> acceleration_rad_s2{};
  Sided<double> current_A{};
  Sided<double> current_slope_A_s{};
  Sided<double> voltage_V{};  ///< NaN where the log has no voltage
  double payload_kg{};
  Sided<bool> turning{};  ///< the wheel turns in one direction within the whole kernel
};

struct SmoothedRun {
  std::string name{};
  std::size_t index{};  ///< in the dataset's runs
  bool has_voltage{};
  bool unsigned_currents{};  ///< current signs come from the motion; braking samples are left out
  SplineKernel kernel{};
  double speed_noise_rad_s{};  ///< white noise of the raw samples; the fit subtracts its share from the
                               ///< normal equations
  std::vector<SmoothedSample> samples{};
};

/// Smooths the runs of a dataset that have wheel speeds (or v and omega) and both motor currents. Samples are
/// interpolated linearly to even time steps and cut at gaps. Other runs are left out.
[[nodiscard]] std::vector<SmoothedRun> smooth_runs(const Dataset& dataset);

}  // namespace joulepath::calibration
