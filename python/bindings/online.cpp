#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>

#include "extensions/onboard/planned_pieces.hpp"
#include "extensions/onboard/replan/follower.hpp"
#include "model/limit_table.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/robot.hpp"

namespace joulepath::python {
namespace {

std::vector<PlannedDrive> drives_of(const Log& planned, const RobotValue& robot) {
  return planned_drives(planned.trajectory, robot.robot).drives;
}

std::vector<PlannedDrive> drives_in(const std::string& directory, const RobotValue& robot) {
  return read_planned_drives(directory, robot.robot).drives;
}

/// A profile that outlives the call that made it.
struct ReplanValue {
  Replan replan{};
  Profile profile{};
};

std::unique_ptr<ReplanValue> replanned(Replanner& replanner, const Situation& situation,
                                       const ReplanBudget& budget) {
  const nb::gil_scoped_release release;
  auto value = std::make_unique<ReplanValue>();
  value->replan = replanner.replan(situation, budget);
  value->profile = *value->replan.profile;
  return value;
}

std::vector<SpeedCap> caps_of(const Caps& rows) {
  std::vector<SpeedCap> caps;
  for (std::size_t i = 0; i < rows.shape(0); ++i) caps.push_back({rows(i, 0), rows(i, 1), rows(i, 2)});
  return caps;
}

void bind_drives(nb::module_& module) {
  nb::class_<PlannedDrive>(module, "PlannedDrive", "A piece of a plan that is driven without a stop.")
      .def_ro("start_s", &PlannedDrive::start_s)
      .def_ro("end_s", &PlannedDrive::end_s)
      .def_ro("leg", &PlannedDrive::leg)
      .def_prop_ro("is_turn", [](const PlannedDrive& self) { return is_turn(self.request.piece); })
      .def_prop_ro("length", [](const PlannedDrive& self) { return piece_length(self.request.piece); })
      .def_prop_ro("payload_kg", [](const PlannedDrive& self) { return self.request.payload.from_kg; })
      .def_prop_ro("max_payload_kg",
                   [](const PlannedDrive& self) { return payload_limit_kg(self.request.plant.robot); })
      .def(
          "pose",
          [](const PlannedDrive& self, double s) {
            const Pose pose = piece_point(self.request.piece, s).pose;
            return std::array{pose.x_m, pose.y_m, pose.heading_rad};
          },
          nb::arg("s"));
  module.def("drives_of", &drives_of, nb::arg("planned"), nb::arg("robot"));
  module.def("drives_in", &drives_in, nb::arg("directory"), nb::arg("robot"));
}

void bind_replanner(nb::module_& module) {
  const auto view = [](std::vector<double> Profile::*channel) {
    return [channel](nb::handle_t<ReplanValue> self) {
      return view_of(nb::cast<ReplanValue&>(self).profile.*channel, self);
    };
  };
  nb::class_<ReplanValue>(module, "ReplanValue", "A new profile from a situation on.")
      .def_prop_ro("status", [](const ReplanValue& self) { return replan_status_name(self.replan.status); })
      .def_prop_ro("limit", [](const ReplanValue& self) { return self.replan.limit; })
      .def_prop_ro("t", view(&Profile::time_s))
      .def_prop_ro("s", view(&Profile::s))
      .def_prop_ro("rate", view(&Profile::rate))
#define JOULEPATH_FIGURE(name) .def_prop_ro(#name, [](const ReplanValue& self) { return self.replan.name; })
          JOULEPATH_FIGURE(duration_s) JOULEPATH_FIGURE(energy_J) JOULEPATH_FIGURE(gap_percent)
              JOULEPATH_FIGURE(price_of_time_W) JOULEPATH_FIGURE(late_s) JOULEPATH_FIGURE(above_cap_until)
                  JOULEPATH_FIGURE(overrun) JOULEPATH_FIGURE(iterations)
#undef JOULEPATH_FIGURE
      ;
  nb::class_<Replanner>(module, "Replanner")
      .def(
          "__init__",
          [](Replanner* self, const PlannedDrive& drive, std::size_t nodes) {
            new (self) Replanner(drive.request, drive.plan, nodes);
          },
          nb::arg("drive"), nb::arg("nodes"))
      .def(
          "replan",
          [](Replanner& self, double s, double rate, double payload_kg, double time_left_s, const Caps& caps,
             double stop_at, int iterations, double cpu_s) {
            const std::vector<SpeedCap> speed_caps = caps_of(caps);
            const Situation situation{.s = s,
                                      .rate = rate,
                                      .payload_kg = payload_kg,
                                      .time_left_s = time_left_s,
                                      .speed_caps = speed_caps,
                                      .stop_at = stop_at};
            return replanned(self, situation, {.iterations = iterations, .cpu_s = cpu_s});
          },
          nb::arg("s"), nb::arg("rate"), nb::arg("payload_kg"), nb::arg("time_left_s"), nb::arg("speed_caps"),
          nb::arg("stop_at"), nb::arg("iterations"), nb::arg("cpu_s"));
}

void bind_follower(nb::module_& module) {
  nb::class_<FollowCommand>(module, "FollowCommand",
                            "Speed and yaw rate from when the command takes effect, their derivatives, and "
                            "`state`: driving, finished (at the end, at rest) or off_path (handed over).")
      .def_prop_ro(
          "state",
          [](const FollowCommand& self) {
            constexpr const char* kNames[] = {"driving", "finished", "off_path"};
            return kNames[static_cast<std::size_t>(self.state)];
          },
          "driving, finished or off_path.")
      .def_ro("speed_m_s", &FollowCommand::speed_m_s, "Signed; of the middle between the wheels.")
      .def_ro("yaw_rate_rad_s", &FollowCommand::yaw_rate_rad_s, "Positive to the left.")
      .def_ro("acceleration_m_s2", &FollowCommand::acceleration_m_s2,
              "From when the command takes effect, for a period.")
      .def_ro("yaw_acceleration_rad_s2", &FollowCommand::yaw_acceleration_rad_s2, "For the same period.")
      .def_ro("s", &FollowCommand::s, "Path coordinate (m or rad) of the pose's projection.")
      .def_ro("lateral_m", &FollowCommand::lateral_m, "Distance of the pose to the left of the path.")
      .def_ro("heading_error_rad", &FollowCommand::heading_error_rad, "Heading less that of the path.")
      .def_ro("late_s", &FollowCommand::late_s, "Of the profile's end, after the deadline.")
      .def_ro("replanned", &FollowCommand::replanned, "Whether this call made a new profile.");
  nb::class_<Follower>(module, "Follower")
      .def(
          "__init__",
          [](Follower* self, const PlannedDrive& drive, double deadline_s, double period_s, double latency_s,
             double off_path_m, double off_path_rad) {
            new (self) Follower(drive.request, drive.plan, deadline_s,
                                {.period_s = period_s,
                                 .latency_s = latency_s,
                                 .off_path_m = off_path_m,
                                 .off_path_rad = off_path_rad});
          },
          nb::arg("drive"), nb::arg("deadline_s"), nb::arg("period_s"), nb::arg("latency_s"),
          nb::arg("off_path_m"), nb::arg("off_path_rad"))
      .def(
          "command",
          [](Follower& self, double time_s, const std::array<double, 3>& pose, double speed_m_s,
             double yaw_rate_rad_s, double payload_kg, std::optional<double> speed_limit_m_s,
             std::optional<double> stop_at_m) {
            const nb::gil_scoped_release release;
            return self.command({.time_s = time_s,
                                 .pose = {pose[0], pose[1], pose[2]},
                                 .speed_m_s = speed_m_s,
                                 .yaw_rate_rad_s = yaw_rate_rad_s,
                                 .payload_kg = payload_kg,
                                 .speed_limit_m_s = speed_limit_m_s,
                                 .stop_at_m = stop_at_m});
          },
          nb::arg("time_s"), nb::arg("pose"), nb::arg("speed_m_s"), nb::arg("yaw_rate_rad_s"),
          nb::arg("payload_kg"), nb::arg("speed_limit_m_s").none(), nb::arg("stop_at_m").none());
}

}  // namespace

void bind_online(nb::module_& module) {
  bind_drives(module);
  bind_replanner(module);
  bind_follower(module);
}

}  // namespace joulepath::python
