#include "benchmarks/growth/growths.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "app/jobs/mission_planner.hpp"
#include "benchmarks/support/counted_memory.hpp"
#include "benchmarks/support/cpu_time.hpp"
#include "diagnosis/signals/run_signals.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "planner/mission/mission.hpp"
#include "planner/profile/profile_solver.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "tests/planner/path/grids.hpp"
#include "tests/support/locations.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath::growth {
namespace {

using Run = std::function<double()>;

/// Sizes from the first one, each the `factor` of the one before, up to the last.
std::vector<double> up_to(double first, double last, double factor) {
  std::vector<double> sizes;
  for (double size = first; size <= last * 1.001; size *= factor) sizes.push_back(std::round(size));
  return sizes;
}

/// A curve of 4 m with both ends at rest.
Run nodes(double count) {
  const Robot robot = testing::nomad();
  const ProfileRequest request{.piece = Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})}),
                               .plant = make_plant(robot),
                               .limits = *robot.limits,
                               .nodes = static_cast<std::size_t>(count),
                               .solver = SolverChoice::fast};
  return [request] { return static_cast<double>(solve_profile(request).summary.iterations); };
}

Plan planned(const MissionRequest& mission) {
  return plan_mission(mission, {.robot = testing::nomad()},
                      {.solver = SolverChoice::fast, .nodes = 40, .baselines = false});
}

/// Curves of different widths, each from rest to rest; if asked, with one deadline 2 % before the economical
/// arrival.
Run legs(double count, bool deadline) {
  MissionRequest mission{.name = "legs"};
  for (int k = 0; k < count; ++k) {
    const double bend_m = 0.5 + 0.5 * std::sin(k);
    const PathRequest path{.bezier_m = {{{{0, 0}, {1, 0}, {2, bend_m}, {3, bend_m}}}}};
    mission.legs.push_back({.path = path});
  }
  if (deadline) mission.legs.back().deadline_s = 0.98 * planned(mission).duration_s;
  return [mission] {
    double iterations = 0;
    for (const LegPlan& leg : planned(mission).legs)
      for (const StretchPlan& stretch : leg.stretches) iterations += stretch.summary.iterations;
    return iterations;
  };
}

/// A warehouse of 3:2 with cells of 5 cm.
Run cells(double count) {
  const double depth_m = 0.05 * std::sqrt(count / 1.5);
  const auto grid = std::make_shared<OccupancyGrid>(warehouse_grid(1, 1.5 * depth_m, depth_m));
  return [grid] {
    const RouteSpace space(*grid, nullptr, {0.25, {}}, 0.05);
    return 0.0;
  };
}

/// Runs of 2,000 samples at 50 Hz with friction that the robot file does not know.
Run runs(double count) {
  Robot truth = testing::nomad();
  for (Side side : kSides) truth.motor[side].friction_torque_Nm *= 1.1;
  Dataset dataset{.file = "dataset.yaml", .robot = testing::nomad()};
  dataset.robot.uncertainty = {{"friction_torque_Nm", 0.015}, {"resistance_ohm", 0.02}};
  for (unsigned k = 0; k < count; ++k)
    dataset.runs.push_back(testing::synthetic_run(truth, "run_" + std::to_string(k), 39.98, 5.0 * (k % 3),
                                                  testing::swinging(0.5, 0.25, 1.1 + 0.2 * (k % 5), 0.3),
                                                  {0.02, 0.02, 0.05}, k + 1));
  return [dataset] {
    const Diagnosis diagnosis = diagnose(dataset, {.bootstrap = 50});
    return 0.0;
  };
}

/// Missions of one curve each, no two alike, on one thread.
Run batch(double count, const std::string& folder) {
  const std::string file = folder + "/missions.jsonl";
  std::ofstream out(file);
  for (int k = 0; k < count; ++k)
    out << R"({"robot": ")" << JOULEPATH_SOURCE_DIR << R"(/tests/data/broken/good/robot.yaml", "legs": )"
        << R"([{"path": {"bezier_m": [[[0, 0], [1, 0], [2, )" << k / count << "], [3, 0.5]]]}}]}\n";
  return [file, folder] {
    MissionJobs jobs(mission_items(file), {.solver = SolverChoice::fast, .nodes = 20, .baselines = false},
                     {});
    return run_job_list(jobs, {.directory = folder + "/results", .force = true, .quiet = true}) ? 0.0 : NAN;
  };
}

/// A log of wheels, voltages and currents at 100 Hz, read and smoothed.
Run hours(double count, const std::string& folder) {
  const std::string log = folder + "/log.csv",
                    robot_file = JOULEPATH_SOURCE_DIR "/tests/data/broken/good/robot.yaml";
  const joulepath::Run minute =
      testing::synthetic_run(testing::nomad(), "log", 60, 0, testing::swinging(0.5, 0.25, 1.3), {}, 1, 0.01);
  std::FILE* out = std::fopen(log.c_str(), "w");
  std::fputs(
      "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,motor_voltage_left_V,motor_voltage_right_V,"
      "motor_current_left_A,motor_current_right_A\n",
      out);
  const auto rows = static_cast<std::size_t>(count * 360000);
  for (std::size_t k = 0; k < rows; ++k) {
    const std::size_t j = k % 6000;
    std::fprintf(out, "%.2f", 0.01 * static_cast<double>(k));
    for (const Sided<std::vector<double>>* channel :
         {&minute.log.wheel_speed_rad_s, &minute.log.motor_voltage_V, &minute.log.motor_current_A})
      for (Side side : kSides) std::fprintf(out, ",%.4f", (*channel)[side][j]);
    std::fputc('\n', out);
  }
  std::fclose(out);
  return [log, robot_file] {
    const Dataset dataset = dataset_of_log(log, robot_file);
    return make_run_signals(dataset.runs.at(0), 0, dataset.robot).size() > 0 ? 0.0 : NAN;
  };
}

}  // namespace

std::vector<Growth> growths(const std::string& folder) {
  std::filesystem::create_directories(folder);
  return {
      {"nodes of a profile",
       up_to(50, 12800, 2),
       {400, 800, 1600, 3200},
       nodes,
       1.0,
       "a Newton step is linear in the nodes and their number hardly changes the steps; coarse grids are "
       "refined "
       "until the energy is exact, which takes more steps than a fine grid"},
      {"legs of a mission",
       {1, 2, 5, 10, 20, 50, 100, 200},
       {4, 8, 16, 32},
       [](double n) { return legs(n, false); },
       1.0,
       "legs are solved one by one"},
      {"legs with one deadline",
       {1, 2, 5, 10, 20, 50, 100, 200},
       {},
       [](double n) { return legs(n, true); },
       1.0,
       "every step of the search for the common price of a second solves all legs; a leg's time is not "
       "smooth in the "
       "price, so that the steps vary between 20 and 70 from size to size: no test of counts"},
      {"cells of a map",
       up_to(1e4, 1e8, 10),
       {4e4, 1.6e5, 6.4e5},
       cells,
       1.1,
       "distance transform and connected regions visit each cell a fixed number of times"},
      {"runs of 2,000 samples",
       {8, 16, 32, 64, 125, 250, 500},
       {},
       runs,
       1.0,
       "runs are read one by one; the rows of all runs together are bounded"},
      {"missions of a batch",
       up_to(50, 800, 2),
       {8, 16, 32},
       [folder](double n) { return batch(n, folder); },
       1.0,
       "missions are independent; a result line is kept for each"},
      {"hours of a log at 100 Hz",
       {0.1, 0.2, 0.5, 1, 2, 5, 10},
       {0.01, 0.02, 0.04},
       [folder](double n) { return hours(n, folder); },
       1.0,
       "each row is read once; the samples after thinning out are bounded"},
  };
}

Work measured(const Growth& growth, double size) {
  const Run run = growth.prepare(size);
  reset_memory_count();
  const double start_ms = cpu_ms();
  const double iterations = run();
  const double end_ms = cpu_ms();
  const MemoryCount memory = memory_count();
  constexpr double kMiB = 1 << 20;
  return {size,
          end_ms - start_ms,
          iterations,
          memory.allocations,
          memory.allocated_bytes / kMiB,
          memory.peak_bytes / kMiB};
}

double exponent(const std::vector<Work>& works, double Work::*value) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Work& work : works) {
    if (!(work.*value > 0)) continue;
    const double a = std::log(work.size), b = std::log(work.*value);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return n > 1 ? (n * xy - x * y) / (n * xx - x * x) : 0.0;
}

}  // namespace joulepath::growth
