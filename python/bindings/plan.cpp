#include "python/bindings/plan.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <ctime>
#include <memory>
#include <optional>
#include <utility>

#include "model/printable.hpp"
#include "planner/accounts/plan_trajectory.hpp"
#include "planner/mission/mission.hpp"
#include "planner/path/shape/waypoint_path.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/robot.hpp"
#include "python/bindings/stop.hpp"
#include "scenarios/export/exports.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/mission_files/mission_source.hpp"
#include "scenarios/mission_files/path_file.hpp"

namespace joulepath::python {
namespace {

std::vector<Point2> points_of(const Points& xy_m) {
  std::vector<Point2> points;
  for (std::size_t i = 0; i < xy_m.shape(0); ++i) points.push_back({xy_m(i, 0), xy_m(i, 1)});
  return points;
}

PathValue waypoint_path(const Points& xy_m, const std::optional<Numbers>& corner_radius_m) {
  WaypointPath along = corner_radius_m ? lines_between(points_of(xy_m), vector_of(*corner_radius_m))
                                       : curve_through(points_of(xy_m));
  if (!along.defect) return {std::move(along.path)};
  const std::string array = along.defect->radius ? "corner_radius_m" : "xy";
  throw ConfigError({{},
                     array + "[" + std::to_string(along.defect->waypoint) + "]",
                     along.defect->found,
                     along.defect->accepted,
                     ""});
}

/// Each as a UserWarning at the caller of the package's function. Needs the GIL.
void warn(const std::vector<std::string>& notes) {
  constexpr int kCallerOfThePackage = 2;
  for (const std::string& note : notes)
    if (PyErr_WarnEx(PyExc_UserWarning, printable(note).c_str(), kCallerOfThePackage) < 0)
      throw nb::python_error();
}

PathValue load_path(const std::string& file) {
  std::vector<std::string> notes;
  PathValue path{is_waypoint_file(file) ? read_waypoints(file, {}, {}, &notes)
                                        : path_from(Document::load(file), {}, &notes)};
  warn(notes);
  return path;
}

/// x, y and heading at path coordinates that are `step_m` apart at most, one list each.
Log path_poses(const PathValue& self, double step_m) {
  Log poses;
  for (const PathPiece& piece : self.path.pieces) {
    const auto steps = static_cast<std::size_t>(std::ceil(piece_length(piece) / step_m));
    for (std::size_t i = 0; i <= steps; ++i) {
      const Pose pose =
          piece_point(piece, piece_length(piece) * static_cast<double>(i) / static_cast<double>(steps)).pose;
      poses.trajectory.position_x_m.push_back(pose.x_m);
      poses.trajectory.position_y_m.push_back(pose.y_m);
      poses.trajectory.heading_rad.push_back(pose.heading_rad);
    }
  }
  return poses;
}

PlanOptions plan_options(const std::string& solver, std::size_t nodes, unsigned seed, double accuracy,
                         bool baselines) {
  return {.solver = solver == "fast" ? SolverChoice::fast : SolverChoice::ipopt,
          .nodes = nodes,
          .accuracy = accuracy,
          .seed = seed,
          .baselines = baselines,
          .path_bound = true};
}

double thread_cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Plans a mission without the GIL.
template <class MakeMission>
std::unique_ptr<PlanValue> planned(const MakeMission& make_mission, const RobotValue* robot,
                                   const PlanOptions& options, nb::handle progress = {}) {
  auto value = std::make_unique<PlanValue>();
  LongCall call(progress);
  const double start_s = thread_cpu_s();
  {
    MissionRequest mission = make_mission();
    MissionWorld world = read_world(mission, {}, robot ? &robot->robot : nullptr);
    Plan plan = plan_mission(mission, world, options);
    value->results = plan_results(std::move(mission), std::move(world), std::move(plan));
  }
  call.finish();
  value->cpu_s = thread_cpu_s() - start_s;
  return value;
}

void bind_path(nb::module_& module) {
  nb::class_<PathValue>(module, "PathValue", "A drivable path.")
      .def_prop_ro("length_m", [](const PathValue& self) { return self.path.distance_m(); })
      .def_prop_ro("turned_rad", [](const PathValue& self) { return self.path.turned_rad(); })
      .def("poses", &path_poses, nb::arg("step_m"), "Position and heading along the path.");
  module.def("waypoint_path", &waypoint_path, nb::arg("xy"), nb::arg("corner_radius_m").none());
  module.def("load_path", &load_path, nb::arg("file"));
}

/// The files of an export: name and content; those of the requested format first.
std::vector<std::pair<std::string, std::string>> exported(const PlanValue& self, const std::string& format,
                                                          const std::string& out_file) {
  const auto& [mission, world, plan, valid, trajectory, json] = self.results;
  const Plant plant = make_plant(world.robot);
  const auto named = std::ranges::find(export_formats(), format, &ExportFormat::name);
  std::vector<std::pair<std::string, std::string>> files;
  for (const ExportFile& file : named->write({mission, world, plan, plant, out_file}).files)
    files.emplace_back(file.name, file.content);
  return files;
}

void bind_plan_value(nb::module_& module) {
  nb::class_<PlanValue>(module, "PlanValue", "A plan with its output files.")
      .def_prop_ro("status",
                   [](const PlanValue& self) { return solve_status_name(self.results.plan.status); })
      .def_prop_ro("message", [](const PlanValue& self) { return self.results.plan.message; })
      .def_prop_ro("driven", [](const PlanValue& self) { return self.results.valid; })
      .def_prop_ro(
          "json", [](const PlanValue& self) { return self.results.json; }, "plan.json")
      .def_prop_ro("cpu_s", [](const PlanValue& self) { return self.cpu_s; })
      .def_prop_ro("robot", [](const PlanValue& self) { return RobotValue{self.results.world.robot}; })
      .def(
          "trajectory", [](const PlanValue& self) { return Log{self.results.trajectory}; },
          "The samples of trajectory.csv.")
      .def(
          "at",
          [](const PlanValue& self, const Numbers& times_s) {
            return Log{plan_trajectory_at(self.results.plan, make_plant(self.results.world.robot),
                                          vector_of(times_s))};
          },
          nb::arg("times_s"), "The plan at ascending times, exact at each.")
      .def(
          "profile_text", [](const PlanValue& self) { return self.results.profile_text(); }, "profile.csv")
      .def("exported", &exported, nb::arg("format"), nb::arg("out_file"),
           "(name, content) of the files that `joulepath export --to FORMAT` writes.")
      .def(
          "report", [](const PlanValue& self) { return self.results.report(); }, "report.html");
}

}  // namespace

void bind_plan(nb::module_& module) {
  bind_path(module);
  bind_plan_value(module);
  module.def(
      "profile",
      [](const RobotValue& robot, const PathValue& path, double payload_kg, std::optional<double> time_s,
         const Caps& speed_caps, const std::string& solver, std::size_t nodes, double accuracy) {
        const MissionSource source{
            .file = "path", .robot_at_hand = true, .payload_kg = payload_kg, .duration_s = time_s};
        const auto along = [&] {
          MissionRequest mission = mission_along(source, path.path);
          for (std::size_t i = 0; i < speed_caps.shape(0); ++i)
            mission.speed_zones.push_back({0, speed_caps(i, 0), speed_caps(i, 1), speed_caps(i, 2)});
          return mission;
        };
        auto plan = planned(along, &robot, plan_options(solver, nodes, 1, accuracy, false));
        const bool driven = plan->results.valid;
        return std::pair(std::move(plan), driven);
      },
      nb::arg("robot"), nb::arg("path"), nb::arg("payload_kg"), nb::arg("time_s").none(),
      nb::arg("speed_caps"), nb::arg("solver"), nb::arg("nodes"), nb::arg("accuracy"),
      "The plan, and whether it can be driven.");
  module.def(
      "plan_file",
      [](const std::string& file, const std::string& robot_file, const RobotValue* robot,
         const std::string& map_file, std::optional<double> payload_kg, std::optional<double> time_s,
         const std::string& solver, std::size_t nodes, unsigned seed, double accuracy, bool baselines,
         nb::handle progress) {
        const MissionSource source{.file = file,
                                   .robot_file = robot_file,
                                   .map_file = map_file,
                                   .robot_at_hand = robot != nullptr,
                                   .payload_kg = payload_kg,
                                   .duration_s = time_s};
        std::vector<std::string> notes;
        auto plan = planned([&] { return read_mission_source(source, {}, &notes); }, robot,
                            plan_options(solver, nodes, seed, accuracy, baselines), progress);
        warn(notes);
        return plan;
      },
      nb::arg("file"), nb::arg("robot_file"), nb::arg("robot").none(), nb::arg("map_file"),
      nb::arg("payload_kg").none(), nb::arg("time_s").none(), nb::arg("solver"), nb::arg("nodes"),
      nb::arg("seed"), nb::arg("accuracy"), nb::arg("baselines"), nb::arg("progress").none());
  module.def(
      "plan_text",
      [](const std::string& text, const std::string& name, const RobotValue* robot, const std::string& solver,
         std::size_t nodes, unsigned seed, double accuracy, bool baselines, nb::handle progress) {
        return from_object(name, [&] {
          return planned([&] { return mission_from(Document::parse(text, name)); }, robot,
                         plan_options(solver, nodes, seed, accuracy, baselines), progress);
        });
      },
      nb::arg("text"), nb::arg("name"), nb::arg("robot").none(), nb::arg("solver"), nb::arg("nodes"),
      nb::arg("seed"), nb::arg("accuracy"), nb::arg("baselines"), nb::arg("progress").none());
}

}  // namespace joulepath::python
