// Scatter of energies from run to run, and the smooth error of a model beside it.
#include "diagnosis/energies_only/energy_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/numerics/indices.hpp"
#include "diagnosis/thresholds.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath {
namespace {

/// Lanes and curves with three payloads. A run measures the model's energy times (1 + `more` + `per_kg` x
/// payload + scatter).
std::vector<EnergyRun> measured_runs(std::size_t rounds, double more, double per_kg, double scatter,
                                     unsigned seed) {
  Dataset dataset{.file = "energies.yaml", .robot = testing::nomad()};
  for (std::size_t round = 0; round < rounds; ++round)
    for (const double payload_kg : {0.0, 5.0, 10.0})
      for (const double turn_rad : {0.0, 2.0, -2.0}) {
        Run run{.name = "run", .payload = {{0.0, payload_kg}}, .payload_known = true};
        run.motion = {.acceleration_m_s2 = 0.2, .speed_m_s = 0.5};
        if (turn_rad == 0)
          run.motion->distance_m = 3.0;
        else
          run.motion->profile = MotionProfile::arc, run.motion->radius_m = 1.0,
          run.motion->angle_rad = turn_rad;
        run.measured_energy_J = Sided<double>{1.0, 1.0};
        dataset.runs.push_back(run);
      }
  std::vector<EnergyRun> runs = energy_runs(dataset);
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  for (EnergyRun& run : runs) {
    const RunJoules joules = joules_of(run.motion, {.robot = dataset.robot});
    const double factor = 1 + more + per_kg * run.payload_kg + scatter * normal(engine);
    run.wheel_J = {joules.wheel_J.left * factor, joules.wheel_J.right * factor};
  }
  return runs;
}

/// An error that depends smoothly on payload or path is the model's and does not count as scatter.
TEST(EnergyNoise, IsWhatASmoothErrorLeaves) {
  for (const double per_kg : {0.0, 0.01}) {
    const EnergyNoise noise =
        estimate_energy_noise(measured_runs(12, 0.05, per_kg, 0.02, 3), testing::nomad());
    EXPECT_NEAR(noise.sum, 0.02, 0.004) << per_kg;
  }
  EXPECT_EQ(estimate_energy_noise(measured_runs(12, 0.05, 0, 0, 3), testing::nomad()).sum, kLeastScatter);
  std::vector<EnergyRun> few = measured_runs(1, 0, 0, 0.2, 3);
  few.resize(5);
  EXPECT_EQ(estimate_energy_noise(few, testing::nomad()).sum, kUsualScatter);
}

/// The mean of |x| of a normal x is sqrt(2/pi) sigma.
TEST(EnergyNoise, FloorIsTheMeanOfItsSize) {
  EXPECT_NEAR(noise_floor_percent({.sum = 0.02}), 2 * std::sqrt(2 / std::numbers::pi), 1e-12);
}

/// Of runs that measure (1 + e) times the model's energy the relative error is -e/(1 + e).
TEST(SmoothError, IsThatOfTheModelOnOtherRuns) {
  const std::vector<EnergyRun> runs = measured_runs(12, 0.1, 0.01, 0, 3);
  std::vector<std::size_t> fitted, judged;
  for (const std::size_t r : every(runs.size())) (r % 4 == 0 ? judged : fitted).push_back(r);
  const Eigen::VectorXd error = smooth_error(runs, fitted, judged, testing::nomad());
  for (std::size_t k = 0; k < judged.size(); ++k) {
    const double more = 0.1 + 0.01 * runs[judged[k]].payload_kg;
    EXPECT_NEAR(error[static_cast<Eigen::Index>(k)], -more / (1 + more), 0.004);
  }
}

/// Downhill a run may return energy: the error counts in units of the energy's size.
TEST(SmoothError, KeepsItsSignForRunsThatReturnEnergy) {
  const std::vector<EnergyRun> runs = measured_runs(8, -2, 0, 0, 3);
  const Eigen::VectorXd error = smooth_error(runs, every(runs.size()), every(runs.size()), testing::nomad());
  EXPECT_GT(error.minCoeff(), 1.5) << "the model's energy less the negative one, over its size, is 2";
}

}  // namespace
}  // namespace joulepath
