#include "planner/profile/infeasibility_finder.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <sstream>

#include "planner/motion/path_motion.hpp"

namespace joulepath {
namespace {

struct LimitKey {
  std::string_view name, key, unit;
  std::function<double&(ProfileRequest&)> value;
};

const std::vector<LimitKey>& limit_keys() {
  using R = ProfileRequest;
  static const std::vector<LimitKey> keys{
      {"speed", "speed_m_s", "m/s", [](R& r) -> double& { return r.limits.speed_m_s; }},
      {"acceleration", "acceleration_m_s2", "m/s^2",
       [](R& r) -> double& { return r.limits.acceleration_m_s2; }},
      {"deceleration", "deceleration_m_s2", "m/s^2",
       [](R& r) -> double& { return r.limits.deceleration_m_s2; }},
      {"lateral_acceleration", "lateral_acceleration_m_s2", "m/s^2",
       [](R& r) -> double& { return r.limits.lateral_acceleration_m_s2; }},
      {"yaw_rate", "yaw_rate_rad_s", "rad/s", [](R& r) -> double& { return r.limits.yaw_rate_rad_s; }},
      {"yaw_acceleration", "yaw_acceleration_rad_s2", "rad/s^2",
       [](R& r) -> double& { return r.limits.yaw_acceleration_rad_s2; }},
      {"wheel_acceleration", "wheel_acceleration_rad_s2", "rad/s^2",
       [](R& r) -> double& { return r.limits.wheel_acceleration_rad_s2; }},
      {"traction", "traction_coefficient", "1",
       [](R& r) -> double& { return r.limits.traction_coefficient; }},
      {"motor_power", "motor_power_W", "W", [](R& r) -> double& { return r.limits.motor_power_W; }},
      {"battery_power", "battery_power_W", "W", [](R& r) -> double& { return r.limits.battery_power_W; }},
      {"motor_current", "max_current_A", "A",
       [](R& r) -> double& { return r.plant.robot.motor.left.max_current_A; }},
      {"motor_voltage", "max_voltage_V", "V",
       [](R& r) -> double& { return r.plant.robot.motor.left.max_voltage_V; }},
      {"start_speed", "start_speed_m_s", "m/s", [](R& r) -> double& { return r.start_rate; }},
      {"end_speed", "end_speed_m_s", "m/s", [](R& r) -> double& { return r.end_rate; }}};
  return keys;
}

/// The value in force: a speed cap on a zone may be lower than the robot's own limit.
double value_of(ProfileRequest& request, const LimitKey& key) {
  double value = key.value(request);
  if (key.name == "speed" && !is_turn(request.piece))
    for (const SpeedCap& cap : request.speed_caps) value = std::min(value, cap.speed_m_s);
  return value;
}

void set_limit(ProfileRequest& request, const LimitKey& key, double value) {
  key.value(request) = key.name == "speed" ? std::max(value, key.value(request)) : value;
  Sided<Motor>& motor = request.plant.robot.motor;
  if (key.name == "motor_current") motor.right.max_current_A = value;
  if (key.name == "motor_voltage") motor.right.max_voltage_V = value;
  if (key.name == "speed")
    for (SpeedCap& cap : request.speed_caps) cap.speed_m_s = std::max(cap.speed_m_s, value);
}

bool passes(const ProfileRequest& request, const std::vector<double>& s) {
  const PathMotion motion = path_motion(request);
  const nlp::Problem problem = nlp::transcribe(request, motion, s, {}, nullptr);
  return !nlp::rate_envelope(problem).blocked;
}

/// Smallest (largest for start and end speeds) value that lets the robot pass, to 1e-4 of it.
std::optional<double> smallest_relaxation(const ProfileRequest& request, const LimitKey& key,
                                          const std::vector<double>& s) {
  ProfileRequest trial = request;
  const double found = value_of(trial, key);
  constexpr double kFirst = 1e-3;  // tried where the limit is zero: anything above it may do
  const bool lower = key.name == "start_speed" || key.name == "end_speed";
  const auto possible = [&](double value) {
    set_limit(trial, key, value);
    return passes(trial, s);
  };
  double bad = found, good = lower ? 0.0 : std::max(2 * found, kFirst);
  for (int i = 0; !possible(good); ++i) {
    if (lower || i > 40) return std::nullopt;
    bad = good;
    good *= 2;
  }
  if (found == 0.0 && good == kFirst) return good;
  for (int i = 0; i < 40 && std::abs(good - bad) > 1e-5 * std::max(std::abs(good), 1e-6); ++i) {
    const double middle = 0.5 * (good + bad);
    (possible(middle) ? good : bad) = middle;
  }
  return good;
}

const LimitKey* key_of(std::string_view name) {
  for (const LimitKey& key : limit_keys())
    if (key.name == name) return &key;
  return nullptr;
}

std::string sentence(const Infeasibility& verdict) {
  std::ostringstream text;
  text.precision(4);
  text << verdict.constraint << " at s = " << verdict.s << " (x " << verdict.x_m << " m, y " << verdict.y_m
       << " m) is missed by " << verdict.amount << " " << verdict.unit;
  for (const auto& [name, value] : verdict.relaxation) text << "; " << name << " " << value << " would do";
  return text.str();
}

Infeasibility at_place(const ProfileRequest& request, std::string constraint, double s) {
  const Pose pose = piece_point(request.piece, s).pose;
  return {.constraint = std::move(constraint), .s = s, .x_m = pose.x_m, .y_m = pose.y_m};
}

}  // namespace

Infeasibility explain_blocked(const ProfileRequest& request, const nlp::Problem& problem,
                              const nlp::Blocked& blocked) {
  std::string_view name = blocked.limit.empty() ? std::string_view("path") : blocked.limit;
  // What has to give first: a start or end speed that the path does not allow, else the limit itself.
  std::vector<std::string_view> candidates;
  if (blocked.node == 0 && request.start_rate > 0) candidates.push_back("start_speed");
  const auto above_cap = [&](double rate, std::size_t node) {
    return rate * rate > problem.cap[node].squared * (1 + 1e-12);
  };
  if (above_cap(request.start_rate, 0)) candidates.push_back("start_speed");
  if (above_cap(request.end_rate, problem.node_count() - 1)) candidates.push_back("end_speed");
  candidates.push_back(name);
  if (request.end_rate > 0) candidates.push_back("end_speed");
  if (request.start_rate > 0) candidates.push_back("start_speed");
  for (const LimitKey& key : limit_keys()) {
    ProfileRequest copy = request;
    if (std::isfinite(key.value(copy)) && key.name != "start_speed" && key.name != "end_speed")
      candidates.push_back(key.name);
  }
  for (std::string_view candidate : candidates) {
    const LimitKey* key = key_of(candidate);
    if (key == nullptr) continue;
    const std::optional<double> value = smallest_relaxation(request, *key, problem.s);
    if (!value) continue;
    ProfileRequest copy = request;
    const double found = value_of(copy, *key);
    double s = problem.s[blocked.node];
    if (candidate == "end_speed") s = problem.s.back();
    Infeasibility verdict = at_place(request, std::string(candidate), s);
    verdict.amount = std::abs(*value - found);
    verdict.unit = key->unit;
    verdict.relaxation[std::string(key->key)] = *value;
    verdict.message = sentence(verdict);
    return verdict;
  }
  Infeasibility verdict = at_place(request, std::string(name), problem.s[blocked.node]);
  verdict.amount = std::sqrt(std::max(0.0, blocked.needed)) - std::sqrt(std::max(0.0, blocked.allowed));
  verdict.unit = is_turn(request.piece) ? "rad/s" : "m/s";
  verdict.message = sentence(verdict) + "; no single limit that is relaxed lets the robot pass";
  return verdict;
}

Infeasibility explain_duration(const ProfileRequest& request, double possible_s) {
  const bool fixed = request.time.mode == TimeMode::fixed_time;
  Infeasibility verdict = at_place(request, fixed ? "duration" : "deadline", piece_length(request.piece));
  const double asked_s = std::isnan(request.time.duration_s) ? 0.0 : request.time.duration_s;
  verdict.amount = std::abs(possible_s - asked_s);
  verdict.unit = "s";
  verdict.relaxation[fixed ? "duration_s" : "deadline_s"] = possible_s;
  verdict.message = sentence(verdict);
  return verdict;
}

Infeasibility explain_request(const ProfileRequest& request, std::string constraint, std::string message) {
  const double length = piece_length(request.piece);
  Infeasibility verdict = at_place(request, std::move(constraint), 0.0);
  verdict.amount = std::isfinite(length) ? length : 0.0;
  verdict.unit = is_turn(request.piece) ? "rad" : "m";
  verdict.message = std::move(message);
  return verdict;
}

}  // namespace joulepath
