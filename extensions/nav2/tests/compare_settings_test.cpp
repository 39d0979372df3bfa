#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/app/program_result.hpp"

namespace joulepath {
namespace {

/// A controller's settings compared with a plan: the document, and a page that says the same.
TEST(CompareSettings, WritesItsPageBesideItsDocument) {
  const ScratchDirectory scratch;
  scratch.write("robot.yaml", text_of(JOULEPATH_SOURCE_DIR "/tests/data/broken/good/robot.yaml"));
  scratch.write("m.yaml",
                "schema: joulepath/mission/1\nname: drive\nrobot: robot.yaml\nlegs:\n"
                "  - {path: {bezier_m: [[[0, 0], [1, 0], [2, 0], [3, 0]]]}}\nobjective: {deadline_s: 20}\n");
  scratch.write("nav2.yaml",
                "velocity_smoother:\n  ros__parameters:\n    max_velocity: [0.5, 0.0, 1.0]\n"
                "    max_accel: [0.5, 0.0, 1.5]\n    max_decel: [-0.5, 0.0, -1.5]\n");
  const std::string arguments = "compare " + scratch.at("m.yaml") + " --nodes 20 --controller " +
                                scratch.at("nav2.yaml") + " --out " + scratch.at("out");
  const ProgramResult result = run_program(scratch, arguments);
  ASSERT_EQ(result.code, 0) << result.err;
  const auto document = nlohmann::json::parse(text_of(scratch.at("out/compare.json")));
  const auto& own = document.at("own_time");
  EXPECT_NEAR(own.at("lost_percent"), 100 * own.at("lost_J").get<double>() / own.at("energy_J").get<double>(),
              1e-9)
      << "percent of the energy of what is compared";
  const std::string page = text_of(scratch.at("out/report.html"));
  EXPECT_NE(page.find("<title>Compare · drive · small · "), std::string::npos);
  EXPECT_NE(page.find("\"loss\":{"), std::string::npos);
  EXPECT_NE(result.out.find("results in "), std::string::npos) << result.out;
}

TEST(ExportFormats, NavIsToldInFull) {
  const ScratchDirectory scratch;
  const ProgramResult result = run_program(scratch, "export m.yaml --to nav --out " + scratch.at("out"));
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("(did you mean nav2_path or nav2_settings?)"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace joulepath
