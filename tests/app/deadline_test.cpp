// A deadline refuses no drive that the mission without it, or with another objective, shows to be possible.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planner/mission/mission.hpp"
#include "planner/profile/profile_solver.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "tests/app/program_result.hpp"

namespace joulepath {
namespace {

struct Asked {
  std::string heading_rad{};
  std::string leg{};  ///< keys of the leg
  std::string objective{};
  std::string robot{};
};

ProgramResult plan_in_depot(const ScratchDirectory& scratch, const Asked& asked) {
  const std::string mission =
      scratch.write("mission.yaml", "schema: joulepath/mission/1\nrobot: " + asked.robot +
                                        "\nmap: " JOULEPATH_SOURCE_DIR
                                        "/scenarios/maps/depot.yaml\nclearance_m: 0.05\n"
                                        "stations:\n  gate: {x_m: 1.5, y_m: 7.5, heading_rad: 0.0}\n"
                                        "  p: {x_m: 8, y_m: 6, heading_rad: " +
                                        asked.heading_rad + "}\nstart: {station: gate}\nlegs:\n  - {to: p" +
                                        asked.leg + "}\nobjective: {" + asked.objective + "}\n");
  return run_program(scratch, "plan " + mission + " --force --out " + scratch.at("plan") +
                                  " --json --solver fast --without baselines");
}

double duration_s(const ProgramResult& result) { return nlohmann::json::parse(result.out)["duration_s"]; }

/// Drafts of ways leave the jerk limit out, and a price of time chooses other ways.
TEST(Deadline, ThatLeastEnergyMeetsIsMetWithAPriceOfTime) {
  const ScratchDirectory scratch;
  std::string robot = text_of(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml");
  robot.insert(robot.find('\n', robot.find("\nlimits:") + 1) + 1, "  jerk_m_s3: 0.4\n");
  const std::string file = scratch.write("robot.yaml", robot);
  const std::string deadline = ", deadline_s: 10.70";
  const ProgramResult frugal = plan_in_depot(scratch, {"3.1", "", "minimize: energy" + deadline, file});
  ASSERT_EQ(frugal.code, 0) << frugal.err << frugal.out;
  const ProgramResult both =
      plan_in_depot(scratch, {"3.1", "", "minimize: energy_and_time, time_value_W: 300" + deadline, file});
  EXPECT_EQ(both.code, 0) << both.err << both.out;
}

/// Whether a way ends with a turn in place, which an end speed refuses, depends on the price of time.
TEST(Deadline, DoesNotRefuseAnEndSpeedThatTheMissionWithoutItKeeps) {
  const ScratchDirectory scratch;
  const std::string file = JOULEPATH_SOURCE_DIR "/scenarios/robots/amr_150kg.yaml";
  const std::string rolling = ", end_speed_m_s: 0.1";
  const ProgramResult free = plan_in_depot(scratch, {"1.677", rolling, "minimize: energy", file});
  ASSERT_EQ(free.code, 0) << free.err << free.out;
  const std::string deadline = std::to_string(0.982 * duration_s(free));
  const ProgramResult sooner =
      plan_in_depot(scratch, {"1.677", rolling, "minimize: energy, deadline_s: " + deadline, file});
  EXPECT_EQ(sooner.code, 0) << sooner.err << sooner.out;
}

/// A machine on an empty hall of 24 m; yaml of its geometry, inertia, motor, limits and power.
struct Machine {
  std::string robot{};
  std::string start_heading_rad{}, goal{}, payload_kg{};
};

const std::vector<Machine> kMachines{
    {"geometry: {wheel_radius_m: 0.0908, half_track_m: 0.2212, center_of_mass_offset_m: 0.08}\n"
     "inertia: {chassis_mass_kg: 84.4, wheel_mass_kg: 2.53, chassis_yaw_inertia_kg_m2: 4.16, "
     "payload_yaw_inertia_m2: 0.02, wheel_axle_inertia_kg_m2: 0.0449, wheel_diameter_inertia_kg_m2: "
     "0.00626}\n"
     "motor: {gear_ratio: 20.264, resistance_ohm: 0.7485, torque_constant_Nm_A: 0.05216, "
     "voltage_constant_V_s_rad: 0.05216, viscous_friction_Nm_s_rad: 0.01016, friction_torque_Nm: 0.2703, "
     "max_voltage_V: 24, max_current_A: 7.611}\n"
     "limits: {speed_m_s: 1.443, reverse_speed_m_s: 0.485, acceleration_m_s2: 0.329, deceleration_m_s2: "
     "0.766, lateral_acceleration_m_s2: 0.518, yaw_rate_rad_s: 1.998, yaw_acceleration_rad_s2: 2.835, "
     "max_payload_kg: 50}\n"
     "power: {standby_W: 22.98, regeneration_efficiency: 0, sharing: wheel}\n",
     "-2.3478", "{x_m: 6.2923, y_m: 4.5578}", "0"},
    {"geometry: {wheel_radius_m: 0.0653, half_track_m: 0.2171, center_of_mass_offset_m: 0}\n"
     "inertia: {chassis_mass_kg: 17.219, wheel_mass_kg: 0.517, chassis_yaw_inertia_kg_m2: 0.8158, "
     "payload_yaw_inertia_m2: 0.02, wheel_axle_inertia_kg_m2: 0.00561, wheel_diameter_inertia_kg_m2: "
     "0.00066}\n"
     "motor: {gear_ratio: 33.219, resistance_ohm: 1.9774, torque_constant_Nm_A: 0.02488, "
     "voltage_constant_V_s_rad: 0.02488, viscous_friction_Nm_s_rad: 0.00624, friction_torque_Nm: 0.1248, "
     "max_voltage_V: 24, max_current_A: 0.853}\n"
     "limits: {speed_m_s: 1.327, reverse_speed_m_s: 0.922, acceleration_m_s2: 0.618, deceleration_m_s2: "
     "0.237, lateral_acceleration_m_s2: 0.305, yaw_rate_rad_s: 1.122, yaw_acceleration_rad_s2: 2.475, "
     "max_payload_kg: 10.33}\n"
     "power: {standby_W: 29.72, regeneration_efficiency: 0, sharing: wheel}\n",
     "0.2445", "{x_m: 2.2648, y_m: 1.5647}", "7.873"}};

/// Writes the hall and the robot; the mission's file, with an objective and keys of the robot's battery.
std::string hall_mission(const ScratchDirectory& scratch, const Machine& machine,
                         const std::string& objective, const std::string& capacity_Wh = "500") {
  scratch.write("hall.pgm", "P5\n240 240\n255\n" + std::string(240 * 240, '\xff'));
  scratch.write("hall.yaml",
                "image: hall.pgm\nmode: trinary\nresolution: 0.1\norigin: [-12.0, -12.0, 0]\nnegate: 0\n"
                "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  scratch.write("robot.yaml", "schema: joulepath/robot/1\nname: r\n" + machine.robot +
                                  "battery: {capacity_Wh: " + capacity_Wh +
                                  ", open_circuit_voltage_V: 25, internal_resistance_ohm: 0.02}\n"
                                  "footprint: {radius_m: 0.32}\n");
  return scratch.write(
      "mission.yaml",
      "schema: joulepath/mission/1\nrobot: robot.yaml\nmap: hall.yaml\nstations:\n  a: {x_m: 0, y_m: 0, "
      "heading_rad: " +
          machine.start_heading_rad + "}\n  b: " + machine.goal +
          "\nstart: {station: a}\nlegs: [{to: b, payload_kg: " + machine.payload_kg + "}]\nobjective: {" +
          objective + "}\n");
}

constexpr double kSame = 1.001;  ///< of the same drive, planned twice

/// A front is one of ways of several plans: a plan with a point's time as its deadline is no dearer, and the
/// plan of least time is no later than its first point.
TEST(Deadline, PlansAreNoDearerThanTheFront) {
  constexpr double kLater = 1e-5;  // of what is written in microseconds, and of least times of two searches
  const ScratchDirectory scratch;
  const auto answer = [&](const std::string& command, const std::string& objective, const Machine& machine) {
    const std::string mission = hall_mission(scratch, machine, objective);
    const ProgramResult result = run_program(
        scratch, command + " " + mission + " --force --out " + scratch.at("out") + " --json --nodes 100");
    EXPECT_EQ(result.code, 0) << command << " " << objective << result.err << result.out;
    return result.code == 0 ? nlohmann::json::parse(result.out) : nlohmann::json();
  };
  for (const Machine& machine : kMachines) {
    const auto front = answer("front --points 8 --baselines 0", "minimize: energy", machine);
    ASSERT_FALSE(front.is_null());
    const auto& points = front["points"];
    const auto fastest =
        answer("plan --solver fast --without baselines,path_bound", "minimize: time", machine);
    EXPECT_LE(fastest["duration_s"].get<double>(), kSame * points.front()["duration_s"].get<double>());
    for (const std::size_t k : {0u, 1u, 3u}) {
      const double time_s = points[k]["duration_s"].get<double>() * (1 + kLater);
      const auto plan = answer("plan --solver fast --without baselines,path_bound",
                               "minimize: energy, deadline_s: " + std::to_string(time_s), machine);
      if (plan.is_null()) continue;
      EXPECT_LE(plan["energy_J"].get<double>(), kSame * points[k]["energy_J"].get<double>())
          << k << ": " << time_s << " s";
    }
  }
}

/// The ways of least energy can just meet such a deadline, at no finite price of time: other ways meet it
/// with less energy.
TEST(Deadline, ThatTheCheapestWaysJustMeetIsMetByCheaperOnes) {
  const ScratchDirectory scratch;
  const PlanOptions options{
      .solver = SolverChoice::fast, .nodes = 100, .baselines = false, .path_bound = false};
  const auto plan = [&](const std::string& objective) {
    const MissionRequest mission = read_mission(hall_mission(scratch, kMachines[0], objective));
    return plan_mission(mission, read_world(mission), options);
  };
  const Plan free = plan("minimize: energy");
  ASSERT_EQ(free.legs.front().stretches.size(), 1u);
  ProfileRequest fastest = free.legs.front().stretches.front().request;
  fastest.time = {.mode = TimeMode::minimum_time};
  const double least_s = solve_profile(fastest).profile.value().duration_s();
  const Plan edge = plan("minimize: energy, deadline_s: " + std::to_string(least_s)),
             later = plan("minimize: energy, deadline_s: " + std::to_string(least_s * (1 + 1e-4)));
  ASSERT_TRUE(is_driven(edge) && is_driven(later)) << edge.message << later.message;
  EXPECT_LE(edge.energy.total_J(), kSame * later.energy.total_J());
}

/// A battery that is slightly too small for every way: the cheapest ways' need is said, not that of the
/// fastest ones, and not that they are late.
TEST(Deadline, AVerdictOnTheBatteryIsThatOfTheCheapestWays) {
  constexpr std::array<double, 2> kLater{1.1, 1.0008};  // than the least time
  const ScratchDirectory scratch;
  for (std::size_t k = 0; k < kMachines.size(); ++k) {
    const auto plan_for = [&](const std::string& objective, double capacity_Wh) {
      const std::string mission = hall_mission(scratch, kMachines[k], objective, std::to_string(capacity_Wh));
      const ProgramResult result =
          run_program(scratch, "plan " + mission + " --force --out " + scratch.at("out") +
                                   " --json --nodes 100 --solver fast --without baselines,path_bound");
      return nlohmann::json::parse(result.out);
    };
    const double least_s = plan_for("minimize: time", 500)["duration_s"];
    const std::string objective = "minimize: energy, deadline_s: " + std::to_string(kLater[k] * least_s);
    const auto plan = [&](double capacity_Wh) { return plan_for(objective, capacity_Wh); };
    const double needed_J = plan(500)["energy_J"];
    const nlohmann::json refused = plan(0.99 * needed_J / 3600);
    ASSERT_EQ(refused["infeasibility"]["constraint"], "battery_reserve") << refused;
    const double offered_Wh = refused["infeasibility"]["relaxation"]["capacity_Wh"];
    EXPECT_LT(offered_Wh * 3600, 1.003 * needed_J) << refused;
  }
}

}  // namespace
}  // namespace joulepath
