#include "model/model_error.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "model/normal_quantiles.hpp"
#include "model/printable.hpp"

namespace joulepath {
namespace {

double sum_of_error_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

}  // namespace

std::string write_model_energy(const std::vector<double>& errors, Robot& robot) {
  const std::size_t count = errors.size();
  const std::string runs = std::to_string(count) + " held-out runs";
  if (count < kLeastHeldOutRuns)
    return "model_energy is not measured: " + runs + " with the energy of their motion, " +
           std::to_string(kLeastHeldOutRuns) + " are needed" +
           (robot.model_energy_sigma() ? "; the robot file's value stays" : "");
  const double n = static_cast<double>(count), rms = std::sqrt(sum_of_error_squares(errors) / n);
  const double wider = boost::math::quantile(boost::math::students_t(n - 1), 0.975) / kNormal95;
  robot.uncertainty["model_energy"] = std::min(wider * rms, 1.0);
  return "model_energy " + four_digits(wider * rms) + ": the energies of " + runs + " are off by " +
         four_digits(rms) + " (rms), times Student's t over the normal distribution's";
}

}  // namespace joulepath
