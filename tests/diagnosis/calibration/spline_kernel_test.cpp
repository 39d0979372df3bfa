#include "diagnosis/calibration/spline_kernel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "diagnosis/calibration/resampling.hpp"
#include "model/student_t.hpp"

namespace joulepath::calibration {
namespace {

TEST(SplineKernel, DerivativeIsThatOfTheSmoothedSignal) {
  const SplineKernel kernel = make_spline_kernel(0.02, 0.15);
  std::vector<double> signal, slope;
  for (int k = 0; k < 200; ++k)
    signal.push_back(std::sin(2 * 0.02 * k)), slope.push_back(2 * std::cos(2 * 0.02 * k));
  for (std::size_t center : {60u, 100u, 130u})
    EXPECT_NEAR(weighted(kernel.derivative, signal, center), weighted(kernel.value, slope, center), 1e-11);
}

TEST(SplineKernel, KeepsConstantsAndTheSlopeOfLines) {
  for (double period_s : {0.01, 0.02, 0.154}) {
    const SplineKernel kernel = make_spline_kernel(period_s, 0.15);
    EXPECT_NEAR(std::accumulate(kernel.value.begin(), kernel.value.end(), 0.0), 1, 1e-13);
    std::vector<double> line;
    for (int k = 0; k < 301; ++k) line.push_back(3 + 0.5 * period_s * k);
    EXPECT_NEAR(weighted(kernel.derivative, line, 150), 0.5, 1e-11);
    EXPECT_NEAR(weighted(kernel.value, line, 150), line[150], 1e-11);
  }
}

TEST(SplineKernel, GainsAreTheVariancesOfSmoothedNoise) {
  const SplineKernel kernel = make_spline_kernel(0.02, 0.15);
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> noise(200000);
  for (double& sample : noise) sample = normal(random);
  double value = 0, derivative = 0;
  int count = 0;
  for (std::size_t k = kernel.reach(); k + kernel.reach() < noise.size(); ++k, ++count) {
    value += std::pow(weighted(kernel.value, noise, k), 2);
    derivative += std::pow(weighted(kernel.derivative, noise, k), 2);
  }
  EXPECT_NEAR(value / count / kernel.value_gain, 1, 0.05);
  EXPECT_NEAR(derivative / count / kernel.derivative_gain, 1, 0.05);
}

TEST(WhiteNoise, IsSeparatedFromSignalAndKinks) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 0.03);
  std::vector<double> samples;
  for (int k = 0; k < 4000; ++k) samples.push_back(std::abs(std::fmod(0.01 * k, 8.0) - 4) + normal(random));
  EXPECT_NEAR(white_noise_deviation(samples), 0.03, 0.002);
}

TEST(Jackknife, OfAMeanIsItsStandardError) {
  const std::vector<double> sample{1, 4, 2, 8, 5, 7, 3};
  const double mean = 30.0 / 7;
  double squares = 0;
  for (double x : sample) squares += (x - mean) * (x - mean);
  const auto result =
      jackknife(sample.size(), [&](std::size_t out) { return std::vector{(30.0 - sample[out]) / 6}; });
  EXPECT_NEAR(result.standard_deviation[0], std::sqrt(squares / 6 / 7), 1e-12);
}

TEST(StudentT, HasTheTabulatedQuantiles) {
  EXPECT_NEAR(student_t_975(1), 12.706, 1e-3);
  EXPECT_NEAR(student_t_975(23), 2.0687, 1e-4);
}

}  // namespace
}  // namespace joulepath::calibration
