#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/equations.hpp"
#include "diagnosis/nuisance.hpp"
#include "diagnosis/refit.hpp"
#include "scenarios/dataset_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {
namespace {

/// A plant's test day of which wheel speeds and currents alone were logged, as on many real robots.
Dataset speeds_and_currents() {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "odd_runs";
  std::filesystem::remove_all(folder);
  const std::string command = std::string(JOULEPATH_BINARY_DIR) +
                              "/bin/blind_plant --effect none --protocol 6 --seed 31 --out " +
                              folder.string();
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
  Dataset dataset = read_dataset((folder / "dataset.yaml").string());
  for (auto& run : dataset.runs) {
    Trajectory& log = run.log;
    log.motor_voltage_V = {};
    for (std::vector<double>* channel :
         {&log.battery_voltage_V, &log.battery_current_A, &log.gyro_yaw_rate_rad_s, &log.position_x_m,
          &log.position_y_m, &log.heading_rad})
      channel->clear();
  }
  return dataset;
}

bool have_plant() { return std::filesystem::exists(std::string(JOULEPATH_BINARY_DIR) + "/bin/blind_plant"); }

TEST(OddRuns, ARunAtRestThroughoutIsNoObstacle) {
  if (!have_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  Dataset dataset = speeds_and_currents();
  auto& still = dataset.runs[1];
  for (Side side : kSides) {
    still.log.wheel_speed_rad_s[side].assign(still.log.size(), 0.0);
    still.log.motor_current_A[side].assign(still.log.size(), 0.0);
  }
  const Diagnosis d = diagnose(dataset, {.bootstrap = 20});
  EXPECT_TRUE(d.causes.empty()) << d.causes.front().effect.name;
}

/// Derivatives by a shape parameter at the end of what the catalog accepts are taken from within.
TEST(OddRuns, AShapeParameterAtItsBoundCanBeLinearized) {
  if (!have_plant()) GTEST_SKIP() << "blind_plant is not built (JOULEPATH_BUILD_BENCHMARKS)";
  const Dataset dataset = speeds_and_currents();
  const std::vector<Nuisance> nuisances = calibration_nuisances(dataset.robot);
  const std::vector<RunSignals> signals = read_signals({.dataset = &dataset, .runs = {0, 1, 2}}, 0.0);
  for (const double trail_m : {0.005, 10.0}) {
    Candidate swivel;
    for (const Candidate& candidate : catalog_candidates(dataset.robot))
      if (candidate.shape.name == "caster_swivel") swivel = candidate;
    swivel.shape.parameters["trail_m"] = trail_m;
    const ModelState state{.nuisance_fraction = std::vector<double>(nuisances.size()),
                           .effects = {{.candidate = swivel, .amplitude = {0.5}}}};
    const Equations equations = build_equations(signals, dataset.robot, nuisances, state, {},
                                                {.whole_catalog = false, .dictionary = false});
    for (const RunEquations& run : equations.runs) EXPECT_TRUE(run.gram.allFinite()) << trail_m;
  }
}

}  // namespace
}  // namespace joulepath
