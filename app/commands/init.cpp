#include <cmath>
#include <filesystem>
#include <iostream>
#include <numbers>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/output_directory.hpp"
#include "app/starter_files.hpp"
#include "model/printable.hpp"
#include "model/simulation/simulate.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/log_files/run_log.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/robot_files/robot_sources.hpp"
#include "scenarios/text/counted.hpp"

namespace joulepath {
namespace {

constexpr int kRuns = 8;

/// A room of 12 x 8 m with two rows of shelves, 5 cm per pixel.
std::string starter_map() {
  constexpr int width = 240, height = 160;
  std::string pixels(static_cast<std::size_t>(width * height), static_cast<char>(254));
  const auto wall = [&](int x0, int x1, int y0, int y1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) pixels[static_cast<std::size_t>((height - 1 - y) * width + x)] = 0;
  };
  wall(0, width, 0, 3);
  wall(0, width, height - 3, height);
  wall(0, 3, 0, height);
  wall(width - 3, width, 0, height);
  wall(50, 190, 45, 60);
  wall(50, 190, 100, 115);
  return "P5\n# a room with two rows of shelves\n240 160\n255\n" + pixels;
}

/// A small test day: both directions, several speeds, turns to both sides; the payload changes between runs.
std::vector<PrescribedMotion> test_run(int index) {
  const double speed_m_s = 0.3 + 0.15 * (index % 4);
  const PrescribedMotion stand{.profile = MotionProfile::stand, .duration_s = 1.0};
  const PrescribedMotion drive{.profile = MotionProfile::trapezoid,
                               .acceleration_m_s2 = 0.15 + 0.05 * (index % 3),
                               .speed_m_s = speed_m_s,
                               .distance_m = 4.0};
  const PrescribedMotion turn{.profile = MotionProfile::spin,
                              .angle_rad = index % 2 == 0 ? std::numbers::pi : -std::numbers::pi,
                              .yaw_rate_rad_s = 0.8};
  return {stand, drive, stand, turn, drive, stand};
}

double payload_kg(int index) { return index % 2 == 0 ? 0.0 : 8.25; }

std::string run_name(int index) { return "run_0" + std::to_string(index + 1) + ".csv"; }

std::string simulated_log(const Robot& robot, int index) {
  const TimedMotion motion = timed_motion(robot, test_run(index), {.payload_kg = payload_kg(index)});
  SimulationRequest request{
      .robot = robot,
      .effects = {{.name = "rolling_resistance", .parameters = {{"coefficient", 0.008}}}},
      .reference = motion.trajectory,
      .payload_kg = payload_kg(index),
      .sensors = typical_sensors(),
      .seed = static_cast<std::uint64_t>(index + 1)};
  return run_log_text(simulate(request).log);
}

class Init : public Command {
 public:
  Init()
      : Command({.name = "init",
                 .says = "write commented example files, or a robot file from files of other programs",
                 .examples = "  joulepath init my_robot\n"
                             "  joulepath init my_robot --from robot.urdf --from motor_sheet.yaml --from "
                             "nav2_params.yaml\n"
                             "  joulepath plan my_robot/mission.yaml --out my_robot/out\n"
                             "  joulepath diagnose my_robot/dataset.yaml --out my_robot/diagnosis"}) {}

  void declare(CommandLine& line) override {
    line.option("DIR", directory_, "directory to write to").required();
    line.option("--from", from_, "write a robot file alone, of what this file says: " + robot_source_names())
        .repeatable();
    line.option("--wheels", wheels_, "with --from: the joints of the left and of the right drive wheel")
        .comma_separated();
    add_common_flags(line, options_, "qf");
  }

  int run() override {
    if (!from_.empty()) return write_draft();
    if (!wheels_.empty())
      throw ConfigError({{"--wheels", 0, 0},
                         "",
                         "a value without --from",
                         "a value only together with --from",
                         "the wheels are joints of the file that --from names"});
    std::vector<std::string> names{"robot.yaml", "map.yaml", "map.pgm", "mission.yaml", "dataset.yaml"};
    for (int i = 0; i < kRuns; ++i) names.push_back(run_name(i));
    OutputDirectory out(directory_, names, options_.force);
    const std::string robot_file(embedded::starter_robot);
    const Robot robot = robot_from(Document::parse(robot_file, "robot.yaml"));
    out.write("robot.yaml", robot_file);
    out.write("map.yaml", std::string(embedded::starter_map));
    out.write("map.pgm", starter_map());
    out.write("mission.yaml", std::string(embedded::starter_mission));
    std::string dataset(embedded::starter_dataset);
    for (int i = 0; i < kRuns; ++i) {
      const std::string payload = i % 2 == 0 ? "0" : "8.25";
      dataset += "  - {file: " + run_name(i) + ", payload_kg: " + payload +
                 ", start_time_s: " + std::to_string(60 * i) + "}\n";
      out.write(run_name(i), simulated_log(robot, i));
    }
    out.write("dataset.yaml", dataset);
    out.commit();
    if (!options_.quiet)
      std::cout << "written to " << out.path() << ": robot.yaml, map.yaml, mission.yaml, dataset.yaml and "
                << kRuns << " simulated runs\n"
                << "next:  joulepath plan " << (std::filesystem::path(out.path()) / "mission.yaml").string()
                << " --out " << (std::filesystem::path(out.path()) / "out").string() << '\n';
    return kDone;
  }

 private:
  /// A robot file of what other programs' files say.
  int write_draft() const {
    OutputDirectory out(directory_, {"robot.yaml"}, options_.force);
    const RobotDraft draft = draft_from(from_, wheels_);
    out.write("robot.yaml", draft_text(draft));
    out.commit();
    if (options_.quiet) return kDone;
    const std::vector<std::string> missing = missing_in(draft);
    std::cout << "written to " << out.path() << ": robot.yaml with " << counted(draft.values.size(), "value")
              << "\n";
    for (const std::string& note : draft.notes) std::cerr << "  note: " << printable(note) << "\n";
    if (!missing.empty())
      std::cout << "missing: " << text_of_list(missing) << " (docs/your_robot.md says where to find them)\n";
    std::cout << "next:  joulepath check " << (std::filesystem::path(out.path()) / "robot.yaml").string()
              << '\n';
    return kDone;
  }

  std::string directory_{};
  std::vector<std::string> from_{}, wheels_{};
  CommonOptions options_{};
};

}  // namespace

std::unique_ptr<Command> make_init_command() { return std::make_unique<Init>(); }

}  // namespace joulepath
