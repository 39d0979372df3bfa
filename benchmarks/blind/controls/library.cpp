#include "library.hpp"

#include <cmath>

namespace control {
namespace {

bool is_current(const Row& row) {
  return row.channel == Channel::current_left || row.channel == Channel::current_right;
}
bool is_voltage(const Row& row) {
  return row.channel == Channel::voltage_left || row.channel == Channel::voltage_right;
}
std::size_t side_of(const Row& row) {
  return row.channel == Channel::current_right || row.channel == Channel::voltage_right ? 1 : 0;
}
double turning(std::size_t side) { return side == 1 ? 1.0 : -1.0; }

/// A column that is a torque at the wheel shaft, opposing or driving; it appears in the current rows only.
Term torque_term(std::string effect, std::string parameter, std::string side,
                 std::function<double(const Instant&, std::size_t)> torque_Nm) {
  return {std::move(effect), std::move(parameter), std::move(side), [torque_Nm](const Row& row) {
            return is_current(row) ? torque_Nm(row.at, side_of(row)) / row.at.robot->torque_per_ampere()
                                   : 0.0;
          }};
}

Term voltage_term(std::string effect, std::string parameter,
                  std::function<double(const Instant&, std::size_t)> volts) {
  return {std::move(effect), std::move(parameter), "",
          [volts](const Row& row) { return is_voltage(row) ? volts(row.at, side_of(row)) : 0.0; }};
}

double total_kg(const Instant& at) { return at.robot->chassis_kg + 2 * at.robot->wheel_kg + at.payload_kg; }

double yaw_inertia(const Instant& at) {
  const Robot& r = *at.robot;
  const double load = r.chassis_kg + at.payload_kg;
  return r.yaw_inertia + r.payload_yaw_inertia_m2 * at.payload_kg +
         load * r.center_offset_m * r.center_offset_m + 2 * r.wheel_kg * r.half_track_m * r.half_track_m +
         2 * r.diameter_inertia;
}

/// Torque of one wheel for a force along the robot and a moment about its axle's middle.
double share_Nm(const Instant& at, std::size_t side, double force_N, double moment_Nm) {
  const Robot& r = *at.robot;
  return r.radius_m * (0.5 * force_N + turning(side) * moment_Nm / (2 * r.half_track_m));
}

void add_mechanics(std::vector<Term>& terms) {
  const auto sign_term = [&](const char* effect, const char* parameter, auto&& size) {
    terms.push_back(torque_term(effect, parameter, "", [size](const Instant& at, std::size_t s) {
      return size(at, s) * at.sign(s);
    }));
  };
  sign_term("coulomb_friction", "torque_Nm", [](const Instant&, std::size_t) { return 1.0; });
  sign_term("rolling_resistance", "coefficient",
            [](const Instant& at, std::size_t) { return at.normal_N() * at.robot->radius_m; });
  sign_term("stribeck_friction", "torque_Nm",
            [](const Instant& at, std::size_t s) { return std::exp(-at.q[s] * at.q[s]); });
  sign_term("gear_efficiency", "loss_fraction", [](const Instant& at, std::size_t s) {
    // Noise-free: regressing on a measured current would include its noise on both sides.
    return std::abs(nominal_torque_Nm(at, s));
  });
  sign_term("direction_dependent_friction", "reverse_torque_Nm",
            [](const Instant& at, std::size_t s) { return at.q[s] < 0 ? 1.0 : 0.0; });
  for (std::size_t wheel = 0; wheel < 2; ++wheel)
    terms.push_back(
        torque_term("dragging_wheel", "torque_Nm", wheel ? "right" : "left",
                    [wheel](const Instant& at, std::size_t s) { return s == wheel ? at.sign(s) : 0.0; }));
  terms.push_back(torque_term("viscous_friction", "coefficient_Nm_s_rad", "",
                              [](const Instant& at, std::size_t s) { return at.q[s]; }));
  terms.push_back(torque_term("turning_scrub", "moment_Nm", "", [](const Instant& at, std::size_t s) {
    return share_Nm(at, s, 0, std::abs(at.w) > 0.02 ? std::copysign(1.0, at.w) : 0.0);
  }));
  terms.push_back(torque_term(
      "quadratic_drag", "coefficient_N_s2_m2", "",
      [](const Instant& at, std::size_t s) { return share_Nm(at, s, at.v * std::abs(at.v), 0); }));
  terms.push_back(torque_term("payload_mass_error", "fraction", "", [](const Instant& at, std::size_t s) {
    const double kg = at.payload_kg;
    return share_Nm(at, s, kg * at.a, at.robot->payload_yaw_inertia_m2 * kg * at.dw);
  }));
  terms.push_back(torque_term("center_of_mass_offset", "offset_m", "", [](const Instant& at, std::size_t s) {
    const double kg = at.robot->chassis_kg + at.payload_kg;
    return share_Nm(at, s, -kg * at.w * at.w, kg * at.v * at.w);
  }));
  terms.push_back(torque_term("yaw_inertia_error", "fraction", "", [](const Instant& at, std::size_t s) {
    return share_Nm(at, s, 0, at.robot->yaw_inertia * at.dw);
  }));
  terms.push_back(torque_term("floor_slope", "cos", "", [](const Instant& at, std::size_t s) {
    return share_Nm(at, s, 9.80665 * total_kg(at) * std::cos(at.heading), 0);
  }));
  terms.push_back(torque_term("floor_slope", "sin", "", [](const Instant& at, std::size_t s) {
    return share_Nm(at, s, 9.80665 * total_kg(at) * std::sin(at.heading), 0);
  }));
}

void add_electrics(std::vector<Term>& terms) {
  terms.push_back(voltage_term("winding_resistance_error", "fraction",
                               [](const Instant& at, std::size_t s) { return at.robot->ohm * at.amps[s]; }));
  terms.push_back(voltage_term("winding_heating", "final_fraction", [](const Instant& at, std::size_t s) {
    return at.robot->ohm * at.amps[s] * (1 - std::exp(-at.day_s / 120));
  }));
  terms.push_back(voltage_term("driver_voltage_drop", "voltage_V", [](const Instant& at, std::size_t s) {
    return std::abs(at.amps[s]) > 0.03 ? std::copysign(1.0, at.amps[s]) : 0.0;
  }));
  terms.push_back({"torque_constant_error", "fraction", "", [](const Row& row) {
                     if (is_voltage(row)) return row.at.robot->torque_per_ampere() * row.at.q[side_of(row)];
                     return is_current(row) ? -row.nominal : 0.0;
                   }});
  terms.push_back({"current_sensor_gain", "fraction", "", [](const Row& row) {
                     if (is_voltage(row)) return -row.at.robot->ohm * row.at.amps[side_of(row)];
                     return is_current(row) ? row.nominal : 0.0;
                   }});
  for (std::size_t wheel = 0; wheel < 2; ++wheel)
    terms.push_back({"current_sensor_offset", "offset_A", wheel ? "right" : "left", [wheel](const Row& row) {
                       if (side_of(row) != wheel) return 0.0;
                       return is_current(row) ? 1.0 : (is_voltage(row) ? -row.at.robot->ohm : 0.0);
                     }});
  terms.push_back({"time_misalignment", "delay_s", "", [](const Row& row) {
                     return is_voltage(row) ? -row.at.robot->torque_per_ampere() * row.at.dq[side_of(row)]
                                            : 0.0;
                   }});
  terms.push_back({"standby_power_error", "power_W", "",
                   [](const Row& row) { return row.channel == Channel::battery_power ? 1.0 : 0.0; }});
  terms.push_back({"regeneration_error", "efficiency", "", [](const Row& row) {
                     double back = 0;
                     for (std::size_t s = 0; s < 2; ++s)
                       back += std::fmin(0.0, row.at.volts[s] * row.at.amps[s]);
                     return row.channel == Channel::battery_power ? back : 0.0;
                   }});
  terms.push_back({"supply_sag", "resistance_ohm", "", [](const Row& row) {
                     return row.channel == Channel::battery_voltage ? -row.at.battery_A : 0.0;
                   }});
}

void add_geometry(std::vector<Term>& terms) {
  const auto yaw_rate = [](const Instant& at) {
    return at.robot->radius_m / (2 * at.robot->half_track_m) * (at.q[1] - at.q[0]);
  };
  terms.push_back({"wheel_radius_error", "fraction", "", [yaw_rate](const Row& row) {
                     if (row.channel == Channel::yaw) return yaw_rate(row.at);
                     return row.channel == Channel::forward ? row.at.v : 0.0;
                   }});
  terms.push_back({"wheel_radius_mismatch", "fraction", "", [](const Row& row) {
                     const Robot& r = *row.at.robot;
                     if (row.channel == Channel::yaw)
                       return -r.radius_m / (4 * r.half_track_m) * (row.at.q[0] + row.at.q[1]);
                     return row.channel == Channel::forward ? r.radius_m / 4 * (row.at.q[0] - row.at.q[1])
                                                            : 0.0;
                   }});
  terms.push_back({"track_width_error", "fraction", "", [yaw_rate](const Row& row) {
                     return row.channel == Channel::yaw ? -yaw_rate(row.at) : 0.0;
                   }});
}

}  // namespace

double nominal_torque_Nm(const Instant& at, std::size_t side) {
  const Robot& r = *at.robot;
  const double mu = (r.chassis_kg + at.payload_kg) * r.center_offset_m;
  const double body =
      share_Nm(at, side, total_kg(at) * at.a - mu * at.w * at.w, yaw_inertia(at) * at.dw + mu * at.v * at.w);
  return body + r.axle_inertia * at.dq[side] + r.viscous * at.q[side] + r.friction_Nm[side] * at.sign(side);
}

std::vector<Term> effect_library(const Robot&) {
  std::vector<Term> terms;
  add_mechanics(terms);
  add_electrics(terms);
  add_geometry(terms);
  return terms;
}

std::vector<Term> parameter_library(const Robot&) {
  std::vector<Term> terms, all = effect_library({});
  const auto take = [&](const char* effect) {
    for (const Term& term : all)
      if (term.effect == effect) terms.push_back(term);
  };
  for (const char* effect :
       {"dragging_wheel", "viscous_friction", "winding_resistance_error", "torque_constant_error",
        "yaw_inertia_error", "wheel_radius_error", "track_width_error"})
    take(effect);
  terms.push_back(torque_term("payload_mass_error", "fraction", "", [](const Instant& at, std::size_t s) {
    return share_Nm(at, s, at.robot->chassis_kg * at.a, 0);
  }));
  terms.push_back(torque_term("axle_inertia", "fraction", "", [](const Instant& at, std::size_t s) {
    return at.robot->axle_inertia * at.dq[s];
  }));
  return terms;
}

std::vector<Row> rows_of(const Robot& robot, const Run& run, std::size_t stride) {
  std::vector<Row> rows;
  const std::size_t n = run.time_s.size(), reach = 12;
  for (std::size_t k = reach; k + reach < n; k += stride) {
    Instant at;
    at.robot = &robot;
    at.payload_kg = run.payload_kg;
    at.day_s = run.start_s + run.time_s[k];
    for (std::size_t s = 0; s < 2; ++s) {
      at.q[s] = run.smooth_speed[s][k];
      at.dq[s] = run.acceleration[s][k];
      at.amps[s] = run.smooth_amps[s][k];
      at.volts[s] = run.volts[s][k];
    }
    const double half = robot.radius_m / 2, across = robot.radius_m / (2 * robot.half_track_m);
    at.v = half * (at.q[0] + at.q[1]), at.w = across * (at.q[1] - at.q[0]);
    at.a = half * (at.dq[0] + at.dq[1]), at.dw = across * (at.dq[1] - at.dq[0]);
    at.heading = run.heading[k];
    at.battery_A = run.battery_A[k];
    double drawn = robot.standby_W;
    for (std::size_t s = 0; s < 2; ++s) {
      const double amps = nominal_torque_Nm(at, s) / robot.torque_per_ampere();
      rows.push_back({s ? Channel::current_right : Channel::current_left, at, amps, run.amps[s][k]});
      const double volts = robot.ohm * at.amps[s] + robot.torque_per_ampere() * at.q[s];
      rows.push_back({s ? Channel::voltage_right : Channel::voltage_left, at, volts, run.volts[s][k]});
      const double power = run.volts[s][k] * at.amps[s];
      drawn += power > 0 ? power : robot.regeneration * power;
    }
    rows.push_back({Channel::yaw, at, at.w, run.gyro[k]});
    const double dt = run.time_s[k + reach] - run.time_s[k - reach];
    const double ahead = ((run.x_m[k + reach] - run.x_m[k - reach]) * std::cos(at.heading) +
                          (run.y_m[k + reach] - run.y_m[k - reach]) * std::sin(at.heading)) /
                         dt;
    if (std::abs(at.w) < 0.1 && std::abs(at.a) < 0.03) rows.push_back({Channel::forward, at, at.v, ahead});
    rows.push_back({Channel::battery_power, at, drawn, run.battery_V[k] * run.battery_A[k]});
    rows.push_back({Channel::battery_voltage, at,
                    robot.open_circuit_V - robot.internal_ohm * run.battery_A[k], run.battery_V[k]});
  }
  return rows;
}

}  // namespace control
