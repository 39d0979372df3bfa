#include "case.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "oracle.hpp"

namespace blind {
namespace {

/// Separate streams of random numbers for the parts of a case, so that parts do not affect one another.
Random stream(const Case& c, std::uint64_t part) { return Random(c.request.seed * 1000003ULL + part); }

/// Streams for the parts that differ from day to day.
Random day_stream(const Case& c, std::uint64_t part) { return stream(c, part + 100000ULL * c.request.day); }

void draw_calibration_error(Case& c) {
  Random random = stream(c, 1);
  c.calibrated = c.nominal;
  for (int k = 0; k < kNuisances; ++k) {
    double sigmas = random.normal();
    while (std::abs(sigmas) > 3) sigmas = random.normal();
    c.calibrated = with_nuisance(c.calibrated, k, sigmas);
  }
}

void scale_noise(SensorNoise& n, double factor) {
  for (double* deviation : {&n.wheel_speed_rad_s, &n.voltage_V, &n.current_A, &n.battery_voltage_V,
                            &n.battery_current_A, &n.gyro_rad_s, &n.position_m, &n.heading_rad})
    *deviation *= factor;
}

/// Sensors are scaled to the machine; those of the Nomad equal the sensors of the practice sets.
void draw_noise(Case& c) {
  Random random = stream(c, 2);
  const Machine nomad = nominal_machine("nomad");
  const auto current = [](const Machine& m) {
    return m.friction_torque_Nm[kLeft] / m.torque_per_ampere_Nm_A();
  };
  c.noise.current_A *= std::max(1.0 / 3, current(c.nominal) / current(nomad));
  c.noise.battery_current_A *= std::max(0.5, current(c.nominal) / current(nomad));
  if (c.request.level == 0) return;
  const int family = random.below(3);  // AR(1), heavy tails, both
  if (family != 1) c.noise.electrical_correlation = random.uniform(0.35, 0.75);
  if (family == 2) c.noise.motion_correlation = random.uniform(0.05, 0.2);
  if (family != 0) c.noise.tail_freedom = 4 + random.below(3);
  c.noise.voltage_V *= random.uniform(0.7, 1.2);
  c.noise.current_A *= random.uniform(1.0, 1.4);
}

void draw_roughness(Case& c) {
  if (c.request.level == 0) return;
  Random random = stream(c, 3);
  const double torque = 0.5 * (c.nominal.friction_torque_Nm[kLeft] + c.nominal.friction_torque_Nm[kRight]);
  c.friction_scatter = random.uniform(0.012, 0.025);
  c.resistance_scatter = random.uniform(0.01, 0.018);
  World& w = c.plain_world;
  w.cogging_per_rev = std::round(random.uniform(12, 40));
  for (std::size_t k = 0; k < 2; ++k) {
    w.cogging_torque_Nm[k] = torque * random.uniform(0.01, 0.04);
    w.cogging_phase_rad[k] = random.uniform(0, 2 * std::numbers::pi);
  }
  w.form = random.uniform(-0.15, 0.15);
  w.rolling_speed_slope_s_m = random.uniform(-0.02, 0.02);
}

std::string label_text(const Case& c, const OracleResult* oracle) {
  std::ostringstream out;
  out << "seed: " << c.request.seed << "\nlevel: " << c.request.level << "\nrobot: " << c.request.robot
      << "\nruns: " << c.request.runs << "\neffects:" << (c.effects.empty() ? " []\n" : "\n");
  for (const Effect& e : c.effects) out << "  - " << effect_line(e) << "\n";
  out << "parameters: " << true_parameters(c.truth) << "\n";
  out << "noise: {electrical_correlation: " << c.noise.electrical_correlation
      << ", tail_freedom: " << c.noise.tail_freedom << ", friction_scatter: " << c.friction_scatter
      << ", resistance_scatter: " << c.resistance_scatter << ", form: " << c.world.form << "}\n";
  if (oracle) out << "oracle: " << oracle_json(*oracle) << "\n";
  return out.str();
}

/// The label as JSON, for the scorer.
std::string label_json(const Case& c, const OracleResult* oracle) {
  std::ostringstream out;
  out << "{\"seed\": " << c.request.seed << ", \"level\": " << c.request.level << ", \"robot\": \""
      << c.request.robot << "\", \"runs\": " << c.request.runs << ", \"effects\": [";
  for (std::size_t k = 0; k < c.effects.size(); ++k) {
    const Effect& e = c.effects[k];
    out << (k ? ", " : "") << "{\"effect\": \"" << e.name
        << "\", \"foreign\": " << (e.foreign ? "true" : "false") << ", \"side\": \"" << e.side
        << "\", \"parameters\": {";
    for (std::size_t j = 0; j < e.parameters.size(); ++j)
      out << (j ? ", " : "") << "\"" << e.parameters[j].first << "\": " << e.parameters[j].second;
    out << "}}";
  }
  out << "]";
  if (oracle) out << ", \"oracle\": " << oracle_json(*oracle);
  out << "}\n";
  return out.str();
}

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
}

/// The payload of a run as the dataset file states it: a number, or steps.
std::string payload_text(const Run& run) {
  std::ostringstream text;
  if (run.reloadings.empty()) {
    text << run.payload_kg;
    return text.str();
  }
  text << "[{from_s: 0, kg: " << run.payload_kg << "}";
  for (const Loading& reloading : run.reloadings)
    text << ", {from_s: " << static_cast<double>(reloading.tick) * kControlPeriod_s
         << ", kg: " << reloading.payload_kg << "}";
  text << "]";
  return text.str();
}

}  // namespace

Case draw_case(const CaseRequest& request) {
  Case c;
  c.request = request;
  c.nominal = nominal_machine(request.robot);
  draw_calibration_error(c);
  draw_noise(c);
  scale_noise(c.noise, request.noise);
  draw_roughness(c);
  Random days = day_stream(c, 4);
  c.runs = test_day(c.nominal, request.runs, days);
  if (request.one_log) c.runs = {one_long_run(c.runs)};
  for (const std::string& description : request.appended) {
    Run run = described_run(description, c.nominal);
    run.start_time_s = std::round(c.runs.back().start_time_s + c.runs.back().duration_s() + 5);
    c.runs.push_back(run);
  }
  c.truth = c.calibrated;
  c.world = c.plain_world;
  for (std::size_t k = 0; k < request.effects.size(); ++k) {
    Random random = stream(c, 10 + k);
    const double size = k < request.sizes.size() ? request.sizes[k] : 0.0,
                 share = k < request.shares.size() ? request.shares[k] : 0.0;
    c.effects.push_back(draw_effect(request.effects[k], c.nominal, size, share, random));
    apply_effect(c.effects.back(), c.nominal, c.truth, c.world);
  }
  return c;
}

Machine machine_in_run(const Case& c, const Machine& base, std::size_t index) {
  Random random = day_stream(c, 1000 + index);
  Machine m = base;
  for (double& t : m.friction_torque_Nm) t *= 1 + c.friction_scatter * random.normal();
  for (double& r : m.resistance_ohm) r *= 1 + c.resistance_scatter * random.normal();
  return m;
}

std::vector<Sample> noise_free_run(const Machine& truth, const Machine& nominal, const World& world,
                                   const Run& run, const Discretization& discretization) {
  std::vector<Sample> log = drive(truth, nominal, world, run, discretization);
  distort(log, world, run.start_time_s);
  return log;
}

void write_case(const Case& c, const std::string& folder) {
  const std::filesystem::path where(folder);
  std::filesystem::create_directories(where);
  write_file(where / "robot.yaml", robot_file(c.nominal));
  std::ostringstream dataset;
  dataset << "schema: joulepath/dataset/1\nrobot: robot.yaml\nruns:\n";
  for (std::size_t k = 0; k < c.runs.size(); ++k) {
    char name[32];
    std::snprintf(name, sizeof name, "run_%02d.csv", static_cast<int>(k) + 1);
    dataset << "  - {file: " << name << ", payload_kg: " << payload_text(c.runs[k])
            << ", start_time_s: " << c.runs[k].start_time_s << "}\n";
    std::vector<Sample> log =
        noise_free_run(machine_in_run(c, c.truth, k), c.nominal, c.world, c.runs[k], Discretization{});
    Random random = day_stream(c, 2000 + k);
    add_noise(log, c.noise, random);
    write_file(where / name, run_csv(log));
  }
  write_file(where / "dataset.yaml", dataset.str());
}

void write_label(const Case& c, const std::string& path, bool with_oracle, bool with_observer) {
  OracleResult oracle;
  if (with_oracle) oracle = consult_oracle(c, with_observer);
  const OracleResult* known = with_oracle ? &oracle : nullptr;
  write_file(path, path.ends_with(".json") ? label_json(c, known) : label_text(c, known));
}

}  // namespace blind
