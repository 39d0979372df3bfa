#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "planner/accounts/edge_energy.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "scenarios/any_file.hpp"
#include "tests/scenarios/export/planned_curves.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath::testing {
namespace {

using Json = nlohmann::json;

double relative(double a, double b) { return std::abs(a - b) / std::abs(b); }

TEST(Export, RowsOfEdgesAddUpToThePlan) {
  double energy_J = 0, duration_s = 0, distance_m = 0;
  for (const EdgeEnergy& edge : edge_energies(curves().plan, curves().plant)) {
    EXPECT_NEAR(edge.start_s, duration_s, 1e-9);
    energy_J += edge.energy.total_J();
    duration_s += edge.duration_s;
    distance_m += edge.distance_m;
  }
  EXPECT_LT(relative(energy_J, curves().plan.energy.total_J()), 1e-7);
  EXPECT_LT(relative(duration_s, curves().plan.duration_s), 1e-9);
  EXPECT_LT(relative(distance_m, curves().plan.distance_m), 1e-9);
  const Json table = Json::parse(export_edges(curves().input("edges.json")).files.at(0).content);
  const std::string csv = export_edges(curves().input("edges.csv")).files.at(0).content;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<long>(table["edges"].size()) + 1);
}

TEST(Export, LastRowOfTheTrajectoryIsThePlansEnergy) {
  const Trajectory motion = plan_trajectory(curves().plan, curves().plant);
  EXPECT_LT(relative(motion.energy_J.back(), curves().plan.energy.total_J()), 1e-7);
}

TEST(Export, RosMessagesEndWithThePlan) {
  const Plan& plan = curves().plan;
  const Json trajectory = Json::parse(export_trajectory(curves().input("t.json")).files.at(0).content);
  const Json path = Json::parse(export_nav2_path(curves().input("p.json")).files.at(0).content);
  const auto time_of = [](const Json& item) {
    const Json& stamp = item["header"]["stamp"];
    return stamp["sec"].get<double>() + 1e-9 * stamp["nanosec"].get<double>();
  };
  EXPECT_NEAR(time_of(trajectory["points"].back()), plan.duration_s, 1e-8);
  EXPECT_NEAR(time_of(path["poses"].back()), plan.duration_s, 1e-8);
  double distance_m = 0;
  const Json& points = trajectory["points"];
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const auto speed = [&](std::size_t i) { return points[i]["velocity"]["linear"]["x"].get<double>(); };
    distance_m += 0.5 * (speed(k) + speed(k + 1)) * (time_of(points[k + 1]) - time_of(points[k]));
    const Json& q = points[k]["pose"]["orientation"];
    EXPECT_NEAR(std::hypot(q["z"].get<double>(), q["w"].get<double>()), 1, 1e-12);
  }
  EXPECT_NEAR(distance_m, plan.distance_m, 0.01 * plan.distance_m);
}

TEST(Export, PlotJugglerHasOneColumnPerName) {
  const std::string csv = export_plotjuggler(curves().input("j.csv")).files.at(0).content;
  const auto line = [&](std::size_t from) { return csv.substr(from, csv.find('\n', from) - from); };
  const std::string header = line(0), row = line(header.size() + 1);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(row.begin(), row.end(), ','));
  EXPECT_EQ(header.find("time_s"), 0u);
}

TEST(Export, EdgesFollowTheirSchema) {
  const ScratchDirectory scratch;
  const Export written = export_edges(curves().input("e.json"));
  EXPECT_EQ(read_any_file(scratch.write("edges.json", written.files.at(0).content)).kind, "edges");
}

}  // namespace
}  // namespace joulepath::testing
