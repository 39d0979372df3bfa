#include "diagnosis/calibration/resampling.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

// Method: [EfronStein1981]
namespace joulepath::calibration {

Resampled jackknife(std::size_t units, const std::function<std::vector<double>(std::size_t)>& estimate) {
  std::vector<std::vector<double>> all;
  for (std::size_t i = 0; i < units; ++i) all.push_back(estimate(i));
  const auto n = static_cast<double>(units);
  Resampled result;
  for (std::size_t k = 0; k < all.front().size(); ++k) {
    double mean = 0, squares = 0;
    for (const auto& one : all) mean += one[k] / n;
    for (const auto& one : all) squares += (one[k] - mean) * (one[k] - mean);
    result.standard_deviation.push_back(std::sqrt((n - 1) / n * squares));
  }
  return result;
}

double student_t_975(double degrees_of_freedom) {
  return boost::math::quantile(boost::math::students_t(std::max(1.0, degrees_of_freedom)), 0.975);
}

}  // namespace joulepath::calibration
