#include "protocol.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace blind {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRest_s = 0.3;
constexpr double kRestBetweenRuns_s = 5.0;

void rest(Run& run, double duration_s) {
  const auto ticks = static_cast<std::size_t>(std::lround(duration_s / kControlPeriod_s));
  run.speed_m_s.insert(run.speed_m_s.end(), ticks, 0.0);
  run.yaw_rate_rad_s.insert(run.yaw_rate_rad_s.end(), ticks, 0.0);
}

/// Append a trapezoid of size `top` (m/s, or rad/s for a spin) with slope `rate`; `emit` turns the
/// profile's value and the distance so far into (speed, yaw rate).
void trapezoid(Run& run, double top, double rate, double cruise_s,
               const std::function<std::pair<double, double>(double, double)>& emit) {
  const double ramp_s = std::abs(top) / rate;
  const double total_s = 2 * ramp_s + cruise_s;
  double distance = 0;
  for (double t = 0; t < total_s; t += kControlPeriod_s) {
    const double up = std::min({1.0, t / ramp_s, (total_s - t) / ramp_s});
    const double value = top * up;
    const auto [speed, yaw_rate] = emit(value, distance);
    run.speed_m_s.push_back(speed);
    run.yaw_rate_rad_s.push_back(yaw_rate);
    distance += std::abs(value) * kControlPeriod_s;
  }
}

Run begin(std::string kind, double payload_kg, double heading_rad) {
  Run run;
  run.kind = std::move(kind);
  run.payload_kg = payload_kg;
  run.heading_rad = heading_rad;
  rest(run, kRest_s);
  return run;
}

Run arc(const std::string& kind, double speed, double rate, double cruise_s, double curvature,
        double payload_kg, double heading_rad) {
  Run run = begin(kind, payload_kg, heading_rad);
  trapezoid(run, speed, rate, cruise_s, [&](double v, double) { return std::pair{v, curvature * v}; });
  rest(run, kRest_s);
  return run;
}

Run spin(double yaw_rate, double rate, double cruise_s, double payload_kg, double heading_rad) {
  Run run = begin("spin", payload_kg, heading_rad);
  trapezoid(run, yaw_rate, rate, cruise_s, [](double w, double) { return std::pair{0.0, w}; });
  rest(run, kRest_s);
  return run;
}

/// A winding lane: curvature swings as a sine of the distance.
Run weave(double speed, double rate, double length_m, double top_curvature, double payload_kg) {
  Run run = begin("weave", payload_kg, 0.0);
  const double cruise_s = (length_m - speed * speed / rate) / speed;
  trapezoid(run, speed, rate, std::max(2.0, cruise_s), [&](double v, double s) {
    return std::pair{v, v * top_curvature * std::sin(2 * kPi * s / (0.5 * length_m))};
  });
  rest(run, kRest_s);
  return run;
}

/// A cubic Bezier curve from the origin: curvature against arc length, tabulated, then driven as a trapezoid.
Run bezier(double speed, double rate, double size_m, double bend, double payload_kg) {
  const double x[4] = {0, 0.6 * size_m, 0.9 * size_m, size_m};
  const double y[4] = {0, 0, bend * 0.3 * size_m, bend * size_m};
  std::vector<double> arc_m{0}, curvature;
  constexpr int kSteps = 400;
  for (int k = 0; k <= kSteps; ++k) {
    const double u = static_cast<double>(k) / kSteps, w = 1 - u;
    const double b[3] = {3 * w * w, 6 * w * u, 3 * u * u}, c[2] = {6 * w, 6 * u};
    double dx = 0, dy = 0, ddx = 0, ddy = 0;
    for (int j = 0; j < 3; ++j) dx += b[j] * (x[j + 1] - x[j]), dy += b[j] * (y[j + 1] - y[j]);
    for (int j = 0; j < 2; ++j) {
      ddx += c[j] * (x[j + 2] - 2 * x[j + 1] + x[j]);
      ddy += c[j] * (y[j + 2] - 2 * y[j + 1] + y[j]);
    }
    const double norm = std::hypot(dx, dy);
    curvature.push_back((dx * ddy - dy * ddx) / (norm * norm * norm));
    if (k < kSteps) arc_m.push_back(arc_m.back() + norm / kSteps);
  }
  const double length_m = arc_m.back();
  Run run = begin("bezier", payload_kg, 0.0);
  const double top = std::min(speed, std::sqrt(0.8 * length_m * rate));
  trapezoid(run, top, rate, (length_m - top * top / rate) / top, [&](double v, double s) {
    const auto at = std::upper_bound(arc_m.begin(), arc_m.end(), s) - arc_m.begin();
    const auto index = std::min(static_cast<std::size_t>(at > 0 ? at - 1 : 0), curvature.size() - 1);
    return std::pair{v, v * curvature[index]};
  });
  rest(run, kRest_s);
  return run;
}

Run stop_and_go(double speed, double rate, double cruise_s, double payload_kg) {
  Run run = begin("stop_and_go", payload_kg, 0.0);
  for (int leg = 0; leg < 2; ++leg) {
    trapezoid(run, speed, rate, cruise_s, [](double v, double) { return std::pair{v, 0.0}; });
    rest(run, 1.5);
  }
  return run;
}

/// The whole repertoire, most informative first: a short day takes a prefix.
std::vector<Run> repertoire(const Machine& m, Random& random) {
  const double v = m.top_speed_m_s, a = m.base_acceleration_m_s2, w = m.base_yaw_rate_rad_s;
  const double turn =
      0.2 / m.half_track_m;  // curvature scale: a wheel-speed difference of the same size on every robot
  const std::vector<double> loads{0.0, 0.24, 0.54, 0.79, 1.0};
  const auto load = [&] {
    return std::round(20 * m.max_payload_kg * loads[static_cast<std::size_t>(random.below(5))]) / 20;
  };
  const auto some = [&](double value) { return value * random.uniform(0.93, 1.07); };
  const auto heading = [&] { return random.uniform(-kPi, kPi); };
  std::vector<Run> runs;
  runs.push_back(arc("straight", some(0.8 * v), 1.25 * a, 5.0, 0, 0.0, 0));
  runs.push_back(arc("straight", some(0.5 * v), 0.62 * a, 5.6, 0, m.max_payload_kg, 0));
  runs.push_back(spin(w, w, 5.2, load(), 0));
  runs.push_back(arc("reverse", some(-0.4 * v), a, 5.8, 0, load(), 0));
  runs.push_back(arc("arc", some(0.4 * v), 1.2 * a, 7.5, turn, load(), heading()));
  runs.push_back(arc("straight", some(v), 1.25 * a, 5.2, 0, load(), kPi / 2));
  runs.push_back(spin(-w, w, 5.2, load(), 0));
  runs.push_back(arc("arc", some(0.4 * v), 1.2 * a, 7.5, -turn, load(), 0));
  runs.push_back(arc("slow", some(0.15 * v), a, 11.0, 0, load(), heading()));
  runs.push_back(arc("straight", some(0.7 * v), 0.9 * a, 5.0, 0, load(), 0));
  runs.push_back(weave(some(0.6 * v), a, 6 * v, 0.6 * turn, load()));
  runs.push_back(arc("straight", some(0.4 * v), a, 5.8, 0, load(), kPi));
  runs.push_back(arc("straight", some(0.4 * v), a, 5.8, 0, load(), -kPi / 2));
  runs.push_back(arc("reverse", some(-0.3 * v), 0.75 * a, 5.8, 0, load(), heading()));
  runs.push_back(arc("arc", some(0.6 * v), 1.1 * a, 5.0, 0.6 * turn, load(), 1.0));
  runs.push_back(arc("tight", some(0.3 * v), a, 8.0, -1.8 * turn, load(), -1.0));
  runs.push_back(arc("straight", some(0.9 * v), a, 5.5, 0, load(), heading()));
  runs.push_back(bezier(some(0.4 * v), a, 2.7 * v, 1.0, load()));
  runs.push_back(arc("straight", some(0.8 * v), 1.25 * a, 5.0, 0, load(), heading()));
  runs.push_back(bezier(some(0.45 * v), a, 3.0 * v, -0.7, load()));
  runs.push_back(arc("straight", some(0.3 * v), a, 10.0, 0, load(), heading()));
  runs.push_back(stop_and_go(some(0.5 * v), 1.3 * a, 1.5, load()));
  runs.push_back(arc("straight", some(0.5 * v), a, 10.0, 0, load(), heading()));
  runs.push_back(weave(some(0.4 * v), a, 4 * v, turn, load()));
  return runs;
}

}  // namespace

std::vector<Run> test_day(const Machine& nominal, int run_count, Random& random) {
  std::vector<Run> runs = repertoire(nominal, random);
  runs.resize(std::min(runs.size(), static_cast<std::size_t>(run_count)));
  for (std::size_t k = runs.size() - 1; k > 0; --k)
    std::swap(runs[k], runs[static_cast<std::size_t>(random.below(static_cast<int>(k) + 1))]);
  double clock_s = 0;
  for (Run& run : runs) {
    run.start_time_s = std::round(clock_s);
    clock_s += run.duration_s() + random.uniform(3.0, 9.0);
  }
  return runs;
}

Run one_long_run(const std::vector<Run>& day) {
  Run all = day.front();
  all.kind = "day";
  for (std::size_t k = 1; k < day.size(); ++k) {
    rest(all, kRestBetweenRuns_s);
    all.speed_m_s.insert(all.speed_m_s.end(), day[k].speed_m_s.begin(), day[k].speed_m_s.end());
    all.yaw_rate_rad_s.insert(all.yaw_rate_rad_s.end(), day[k].yaw_rate_rad_s.begin(),
                              day[k].yaw_rate_rad_s.end());
  }
  return all;
}

namespace {

using Description = std::map<std::string, std::string>;

Description description_of(const std::string& text) {
  Description given;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    const std::size_t colon = part.find(':');
    if (colon == std::string::npos)
      throw std::invalid_argument("a motion is key:value,..., not '" + part + "'");
    given[part.substr(0, colon)] = part.substr(colon + 1);
  }
  return given;
}

double number(const Description& given, const char* key, double fallback) {
  const auto at = given.find(key);
  return at == given.end() ? fallback : std::stod(at->second);
}

std::string word(const Description& given, const char* key, const char* fallback) {
  const auto at = given.find(key);
  return at == given.end() ? fallback : at->second;
}

/// One leg from rest to rest, appended to the run.
void append_leg(Run& run, const Description& given, const Machine& m) {
  const double rate = number(given, "acceleration_m_s2", m.base_acceleration_m_s2);
  const std::string profile = word(given, "profile", "trapezoid");
  if (profile == "stand") return rest(run, number(given, "duration_s", 10));
  if (profile == "spin") {
    const double angle = number(given, "angle_rad", 4.0),
                 yaw = std::copysign(number(given, "yaw_rate_rad_s", m.base_yaw_rate_rad_s), angle),
                 slope = number(given, "yaw_acceleration_rad_s2", m.base_yaw_rate_rad_s);
    const double cruise_s = number(given, "duration_s", std::abs(angle / yaw) - std::abs(yaw) / slope);
    trapezoid(run, yaw, slope, std::max(1.0, cruise_s), [](double w, double) { return std::pair{0.0, w}; });
    return rest(run, kRest_s);
  }
  const double radius = number(given, "radius_m", 0), angle = number(given, "angle_rad", 2.0);
  const double distance = radius > 0 ? std::abs(angle) * radius : number(given, "distance_m", 4.0);
  const double wanted =
      number(given, "speed_m_s", rate * number(given, "ramp_s", 0.5 * m.top_speed_m_s / rate));
  const double speed = std::min(wanted, std::sqrt(0.9 * rate * distance));
  const double cruise_s = std::max(0.5, number(given, "duration_s", distance / speed - speed / rate));
  const double curvature = radius > 0 ? std::copysign(1.0 / radius, angle) : 0.0;
  const double direction = word(given, "direction", "forward") == "reverse" ? -1 : 1;
  trapezoid(run, direction * speed, rate, cruise_s, [&](double v, double) {
    return std::pair{v, curvature * v};
  });
  rest(run, kRest_s);
}

}  // namespace

Run described_run(const std::string& description, const Machine& m) {
  std::istringstream in(description);
  Run run;
  for (std::string leg; std::getline(in, leg, '+');) {
    const Description given = description_of(leg);
    if (run.kind.empty())
      run = begin("described", number(given, "payload_kg", 0), number(given, "heading_rad", 0));
    const double before_kg = run.reloadings.empty() ? run.payload_kg : run.reloadings.back().payload_kg;
    const double payload_kg = number(given, "payload_kg", before_kg);
    if (payload_kg != before_kg) run.reloadings.push_back({run.speed_m_s.size(), payload_kg});
    append_leg(run, given, m);
  }
  if (run.kind.empty()) throw std::invalid_argument("a described run needs a leg");
  return run;
}

}  // namespace blind
