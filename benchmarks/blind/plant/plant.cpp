#include "plant.hpp"

#include <cmath>

#include "bodies.hpp"
// Design: docs/decisions/0802-blind-benchmark.md
namespace blind {

std::vector<Sample> drive(const Machine& truth, const Machine& nominal, const World& world, const Run& run,
                          const Discretization& d) {
  Plant plant(truth, nominal, world, run, d);
  const auto steps_per_tick = static_cast<int>(std::lround(kControlPeriod_s / d.step_s));
  const auto ticks_per_sample = static_cast<int>(std::lround(kSamplePeriod_s / kControlPeriod_s));
  const double steps_per_sample = steps_per_tick * ticks_per_sample;
  std::vector<Sample> log;
  Sample sum;
  Pair angle_before{};
  double heading_before = run.heading_rad;
  for (std::size_t tick = 0; tick < run.speed_m_s.size(); ++tick) {
    plant.control(tick);
    for (int k = 0; k < steps_per_tick; ++k) {
      plant.step(run.start_time_s + static_cast<double>(tick) * kControlPeriod_s);
      for (std::size_t side = 0; side < 2; ++side) {
        const Wheel& wheel = plant.wheel(side);
        sum.motor_voltage_V[side] += wheel.commanded_V;
        sum.motor_current_A[side] += wheel.current_A;
        sum.true_power_W[side] += wheel.voltage_V * wheel.current_A;
      }
      sum.battery_voltage_V += plant.battery_V();
      sum.battery_current_A += plant.battery_A();
    }
    if ((tick + 1) % static_cast<std::size_t>(ticks_per_sample) != 0) continue;
    sum.time_s = static_cast<double>(tick + 1) * kControlPeriod_s;
    for (std::size_t side = 0; side < 2; ++side) {
      const double angle = plant.encoder_rad(side);
      sum.wheel_speed_rad_s[side] = (angle - angle_before[side]) / kSamplePeriod_s;
      angle_before[side] = angle;
      sum.motor_voltage_V[side] /= steps_per_sample;
      sum.motor_current_A[side] /= steps_per_sample;
      sum.true_power_W[side] /= steps_per_sample;
    }
    sum.battery_voltage_V /= steps_per_sample;
    sum.battery_current_A /= steps_per_sample;
    sum.gyro_rad_s = (plant.heading_rad() - heading_before) / kSamplePeriod_s;
    heading_before = plant.heading_rad();
    sum.x_m = plant.x_m();
    sum.y_m = plant.y_m();
    sum.heading_rad = plant.heading_rad();
    log.push_back(sum);
    sum = Sample{};
  }
  return log;
}

}  // namespace blind
