#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "model/estimate.hpp"
#include "model/simulation/simulate.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/errors.hpp"
#include "python/bindings/plan.hpp"
#include "python/bindings/robot.hpp"
#include "python/bindings/stop.hpp"
#include "scenarios/log_files/simulation_input.hpp"
#include "scenarios/robot_files/effect_list.hpp"

namespace joulepath::python {
namespace {

struct SimulationValue {
  SimulationResult result{};
};

std::vector<EffectSetting> effects_from(const std::string& text) {
  return from_object("effects", [&] {
    const Document document = Document::parse(text, "effects");
    check_value(document.root(), effect_list_schema());
    return read_effect_list(document.root());
  });
}

SimulationValue simulated(const SimulationInput& input, const std::string& effects, bool ideal_sensors,
                          double time_of_day_s, double sample_rate_Hz, std::uint64_t seed) {
  SimulationRequest request = simulation_request(input, effects_from(effects), ideal_sensors, seed);
  request.time_of_day_s = time_of_day_s;
  request.sensors.sample_rate_Hz = sample_rate_Hz;
  const LongCall call;
  return {simulate(request)};
}

EnergyEstimate energy_of(const RobotValue& robot, const Numbers& t, const Numbers& v, const Numbers& w,
                         const Numbers& payload_kg) {
  const Trajectory motion{.time_s = vector_of(t),
                          .linear_speed_m_s = vector_of(v),
                          .angular_speed_rad_s = vector_of(w),
                          .payload_kg = vector_of(payload_kg)};
  const LongCall call;
  return estimate_energy(make_plant(robot.robot), motion, {.reach_s = 0.0});
}

}  // namespace

void bind_simulation(nb::module_& module) {
  nb::class_<SimulationValue>(module, "SimulationValue", "A simulated run.")
      .def("log", [](const SimulationValue& self) { return Log{self.result.log}; })
      .def("executed", [](const SimulationValue& self) { return Log{self.result.executed}; })
      .def_prop_ro("energy_J", [](const SimulationValue& self) { return self.result.energy_J; })
      .def_prop_ro("duration_s", [](const SimulationValue& self) { return self.result.duration_s; });
  module.def(
      "simulate",
      [](const PlanValue& plan, const RobotValue* robot, const std::string& effects, bool ideal_sensors,
         double time_of_day_s, double sample_rate_Hz, std::uint64_t seed) {
        const PlanResults& of = plan.results;
        return simulated(simulation_input(of.plan, of.trajectory, robot ? robot->robot : of.world.robot),
                         effects, ideal_sensors, time_of_day_s, sample_rate_Hz, seed);
      },
      nb::arg("plan"), nb::arg("robot").none(), nb::arg("effects"), nb::arg("ideal_sensors"),
      nb::arg("time_of_day_s"), nb::arg("sample_rate_Hz"), nb::arg("seed"));
  nb::class_<EnergyEstimate>(module, "EnergyValue", "The energy of a motion.")
      .def_prop_ro("total_J", [](const EnergyEstimate& self) { return self.by_cause.total_J(); })
      .def_prop_ro("battery_loss_J", [](const EnergyEstimate& self) { return self.battery_loss_J; })
      .def_prop_ro("distance_m", [](const EnergyEstimate& self) { return self.distance_m; })
      .def_prop_ro("duration_s", [](const EnergyEstimate& self) { return self.duration_s; })
      .def("causes_J", [](const EnergyEstimate& self) { return named_causes_J(self.by_cause); })
      .def("power", [](const EnergyEstimate& self) { return Log{self.power}; });
  module.def("energy", &energy_of, nb::arg("robot"), nb::arg("t"), nb::arg("v"), nb::arg("w"),
             nb::arg("payload_kg"));
}

}  // namespace joulepath::python
