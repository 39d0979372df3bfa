#include "diagnosis/estimation/run_motion.hpp"

#include "diagnosis/values/constant_payload.hpp"
#include "model/motions.hpp"
#include "model/watt_hours.hpp"

namespace joulepath {

RunMotion run_motion(const Run& run, const Robot& robot, EstimateOptions options) {
  options.time_of_day_s = run.start_time_s.value_or(0.0);
  if (run.motion) options.reach_s = 0.0;
  const double payload_kg = constant_payload_kg(run);
  if (run.motion) return {timed_motion(robot, {*run.motion}, {.payload_kg = payload_kg}).trajectory, options};
  Trajectory log = run.log;
  if (log.payload_kg.empty()) log.payload_kg.assign(log.size(), payload_kg);
  return {std::move(log), options};
}

MeasuredEnergy measured_energy(const Run& run, const Robot& robot) {
  MeasuredEnergy measured{
      .motor_J = run.motion ? run.measured_energy_J
                            : measured_motor_energy_J(run.log, robot.power.regeneration_efficiency)};
  if (run.battery_energy_Wh) measured.battery_J = kJoulesPerWh * *run.battery_energy_Wh;
  if (!run.motion && !measured.battery_J) measured.battery_J = measured_battery_energy_J(run.log);
  return measured;
}

}  // namespace joulepath
