#include "sensors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace blind {
namespace {

/// One channel's noise: AR(1) of unit variance times its standard deviation.
class Channel {
 public:
  Channel(double deviation, double correlation, int freedom, Random& random)
      : deviation_(deviation), correlation_(correlation), freedom_(freedom), random_(random) {
    level_ = innovation();
  }
  double next() {
    level_ = correlation_ * level_ + std::sqrt(1 - correlation_ * correlation_) * innovation();
    return deviation_ * level_;
  }

 private:
  double innovation() { return freedom_ > 2 ? random_.student(freedom_) : random_.normal(); }
  double deviation_, correlation_;
  int freedom_;
  Random& random_;
  double level_{};
};

double rounded(double value, double step) {
  const double x = step * std::round(value / step);
  return x == 0 ? 0.0 : x;
}

}  // namespace

void distort(std::vector<Sample>& log, const World& w, double start_time_s) {
  if (w.electrical_delay_s > 0) {
    const double late = w.electrical_delay_s / kSamplePeriod_s;
    const auto whole = static_cast<std::size_t>(late);
    const double part = late - std::floor(late);
    for (std::size_t k = log.size(); k-- > 0;) {
      const Sample& near = log[k >= whole ? k - whole : 0];
      const Sample& far = log[k >= whole + 1 ? k - whole - 1 : 0];
      Sample out = log[k];
      for (std::size_t side = 0; side < 2; ++side) {
        out.motor_voltage_V[side] =
            (1 - part) * near.motor_voltage_V[side] + part * far.motor_voltage_V[side];
        out.motor_current_A[side] =
            (1 - part) * near.motor_current_A[side] + part * far.motor_current_A[side];
      }
      log[k] = out;
    }
  }
  for (Sample& s : log)
    for (std::size_t side = 0; side < 2; ++side) {
      const double drift = w.form * 0.5 * w.current_offset_A[side] * (start_time_s + s.time_s - 200) / 200;
      s.motor_current_A[side] =
          s.motor_current_A[side] * (1 + w.current_gain) + w.current_offset_A[side] + drift;
      s.wheel_speed_rad_s[side] *= 1 + w.encoder_drift[side] * (start_time_s + s.time_s) / 400.0;
    }
}

void add_noise(std::vector<Sample>& log, const SensorNoise& n, Random& random) {
  const int t = n.tail_freedom;
  std::array<Channel, 2> speed{Channel{n.wheel_speed_rad_s, n.motion_correlation, t, random},
                               Channel{n.wheel_speed_rad_s, n.motion_correlation, t, random}};
  std::array<Channel, 2> voltage{Channel{n.voltage_V, n.electrical_correlation, t, random},
                                 Channel{n.voltage_V, n.electrical_correlation, t, random}};
  std::array<Channel, 2> current{Channel{n.current_A, n.electrical_correlation, t, random},
                                 Channel{n.current_A, n.electrical_correlation, t, random}};
  Channel gyro{n.gyro_rad_s, n.motion_correlation, t, random};
  for (Sample& s : log) {
    for (std::size_t side = 0; side < 2; ++side) {
      s.wheel_speed_rad_s[side] += speed[side].next();
      s.motor_voltage_V[side] += voltage[side].next();
      s.motor_current_A[side] += current[side].next();
    }
    s.gyro_rad_s += gyro.next();
    s.battery_voltage_V += n.battery_voltage_V * random.normal();
    s.battery_current_A += n.battery_current_A * random.normal();
    s.x_m += n.position_m * random.normal();
    s.y_m += n.position_m * random.normal();
    s.heading_rad += n.heading_rad * random.normal();
  }
}

std::string run_csv(const std::vector<Sample>& log) {
  std::string out =
      "time_s,wheel_speed_left_rad_s,wheel_speed_right_rad_s,motor_voltage_left_V,motor_voltage_right_V,"
      "motor_current_left_A,motor_current_right_A,battery_voltage_V,battery_current_A,gyro_yaw_rate_rad_s,"
      "position_x_m,position_y_m,heading_rad\n";
  char line[256];
  for (const Sample& s : log) {
    std::snprintf(line, sizeof line, "%.3f,%.3f,%.3f,%.2f,%.2f,%.3f,%.3f,%.2f,%.3f,%.4f,%.3f,%.3f,%.4f\n",
                  s.time_s, rounded(s.wheel_speed_rad_s[kLeft], 0.002),
                  rounded(s.wheel_speed_rad_s[kRight], 0.002), rounded(s.motor_voltage_V[kLeft], 0.01),
                  rounded(s.motor_voltage_V[kRight], 0.01), rounded(s.motor_current_A[kLeft], 0.005),
                  rounded(s.motor_current_A[kRight], 0.005), rounded(s.battery_voltage_V, 0.01),
                  rounded(s.battery_current_A, 0.005), rounded(s.gyro_rad_s, 0.0001), rounded(s.x_m, 0.001),
                  rounded(s.y_m, 0.001), rounded(s.heading_rad, 0.0001));
    out += line;
  }
  return out;
}

}  // namespace blind
