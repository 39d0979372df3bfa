// A deadline refuses no drive that the mission without it, or with another objective, shows to be possible.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace joulepath
