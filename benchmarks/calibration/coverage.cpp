// Coverage of the calibration's 95 % intervals, and errors of its values, over simulated calibrations with a
// plant that shares no code with the product.
//   bench_calibration PLANT_PROGRAM SCRATCH_FOLDER SETS_PER_LEVEL FIRST_SEED
// Prints Markdown tables.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/calibration/calibration.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

/// The results for one parameter over all sets.
struct Tally {
  int intervals{}, held{}, unseen{};
  double squares{}, bias{}, widths{}, worst{};

  void add(const CalibratedParameter& parameter, double truth) {
    if (parameter.visibility == Visibility::unseen) {
      ++unseen;
      return;
    }
    const double error = parameter.value / truth - 1;
    ++intervals;
    held += parameter.interval_95[0] <= truth && truth <= parameter.interval_95[1];
    squares += error * error, bias += error, worst = std::max(worst, std::abs(error));
    widths += 0.5 * (parameter.interval_95[1] - parameter.interval_95[0]) / truth;
  }
};

/// The drawn values of a label, under the names that calibration reports.
std::map<std::string, double> truth_of(const std::string& file, const Robot& nominal) {
  const Document label = Document::load(file);
  const Node drawn = label.root()["parameters"];
  const double r =
      0.5 * (drawn["wheel_radius_m"]["left"].number() + drawn["wheel_radius_m"]["right"].number());
  const double l = drawn["half_track_m"].number(), axle = drawn["wheel_axle_inertia_kg_m2"].number();
  const double mass = drawn["chassis_mass_kg"].number() + 2 * nominal.inertia.wheel_mass_kg;
  const double yaw = drawn["chassis_yaw_inertia_kg_m2"].number() + 2 * nominal.inertia.wheel_mass_kg * l * l +
                     2 * nominal.inertia.wheel_diameter_inertia_kg_m2;
  const double viscous = drawn["viscous_friction_Nm_s_rad"].number();
  return {{"friction_torque_left_Nm", drawn["friction_torque_Nm"]["left"].number()},
          {"friction_torque_right_Nm", drawn["friction_torque_Nm"]["right"].number()},
          {"viscous_friction_Nm_s_rad", viscous},
          {"viscous_friction_left_Nm_s_rad", viscous},
          {"viscous_friction_right_Nm_s_rad", viscous},
          {"straight_inertia_kg_m2", mass * r * r / 2 + axle},
          {"turning_inertia_kg_m2", yaw * r * r / (2 * l * l) + axle},
          {"payload_factor", drawn.number_or("payload_factor", 1.0)},
          {"torque_per_ampere_Nm_A", drawn["torque_constant_Nm_A"].number() * nominal.motor.left.gear_ratio},
          {"resistance_ohm", drawn["resistance_ohm"].number()},
          {"wheel_axle_inertia_kg_m2", axle},
          {"chassis_yaw_inertia_kg_m2", drawn["chassis_yaw_inertia_kg_m2"].number()}};
}

void print_table(const std::string& title, const std::vector<std::pair<std::string, Tally>>& tallies) {
  std::printf(
      "\n### %s\n\n| parameter | intervals | cover the truth %% | rms error %% | bias %% | worst %% | mean "
      "half "
      "width %% | unseen |\n|---|---|---|---|---|---|---|---|\n",
      title.c_str());
  Tally all;
  for (const auto& [name, tally] : tallies) {
    const double n = std::max(1, tally.intervals);
    std::printf("| %s | %d | %.1f | %.3f | %+.3f | %.3f | %.3f | %d |\n", name.c_str(), tally.intervals,
                100 * tally.held / n, 100 * std::sqrt(tally.squares / n), 100 * tally.bias / n,
                100 * tally.worst, 100 * tally.widths / n, tally.unseen);
    all.intervals += tally.intervals, all.held += tally.held;
  }
  std::printf("| **all** | %d | **%.2f** | | | | | |\n", all.intervals,
              100.0 * all.held / std::max(1, all.intervals));
}

/// Tallies of one method, in the order of its parameters.
struct Tallies {
  CalibrationMethod method{};
  std::vector<std::pair<std::string, Tally>> rows{};

  void add(const CalibrationResult& result, const std::map<std::string, double>& truth) {
    if (rows.empty())
      for (const CalibratedParameter& parameter : result.parameters)
        rows.emplace_back(parameter.name, Tally{});
    for (std::size_t i = 0; i < rows.size(); ++i)
      rows[i].second.add(result.parameters[i], truth.at(rows[i].first));
  }
};

void campaign(const std::string& plant, const std::string& scratch, int sets, int first_seed, int level) {
  Tallies all[] = {{CalibrationMethod::full}, {CalibrationMethod::steady}};
  for (int seed = first_seed; seed < first_seed + sets; ++seed) {
    const std::string folder = scratch + "/set";
    const std::string command = plant + " --effect none --level " + std::to_string(level) + " --seed " +
                                std::to_string(seed) + " --out " + folder + " > /dev/null";
    if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
    const Dataset dataset = read_dataset(folder + "/dataset.yaml");
    const auto truth = truth_of(folder + "/truth.yaml", dataset.robot);
    for (Tallies& tallies : all) tallies.add(calibrate(dataset, tallies.method), truth);
    std::filesystem::remove_all(folder);
    std::fprintf(stderr, "\r%d of %d", seed - first_seed + 1, sets);
  }
  std::fprintf(stderr, "\n");
  for (const Tallies& tallies : all)
    print_table(std::string(tallies.method == CalibrationMethod::full ? "Full method" : "Steady method") +
                    ", " + (level == 0 ? "white noise (level 0)" : "rough (level 1)") + ", " +
                    std::to_string(sets) + " sets",
                tallies.rows);
  std::fflush(stdout);
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: bench_calibration PLANT_PROGRAM SCRATCH_FOLDER SETS_PER_LEVEL FIRST_SEED\n");
    return 2;
  }
  try {
    for (int level : {0, 1})
      joulepath::campaign(argv[1], argv[2], std::atoi(argv[3]), std::atoi(argv[4]), level);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_calibration: %s\n", error.what());
    return 1;
  }
}
