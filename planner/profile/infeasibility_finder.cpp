#include "planner/profile/infeasibility_finder.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "model/limit_table.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/profile/holding_limit.hpp"
#include "planner/profile/profile_solver.hpp"
#include "planner/profile/solve_tolerances.hpp"
#include "planner/values/verdict_text.hpp"

namespace joulepath {
namespace {

/// A value that a verdict may relax: a limit, or the speed at an end.
struct RelaxableLimit {
  std::string_view name{}, key{}, unit{};
  const Limit* limit{};
  double ProfileRequest::*rate{};
};

const std::vector<RelaxableLimit>& relaxable_limits() {
  static const std::vector<RelaxableLimit> all = [] {
    std::vector<RelaxableLimit> list;
    for (const Limit& row : kLimits)
      if (row.value != nullptr)
        list.push_back({.name = row.name, .key = row.key, .unit = row.unit, .limit = &row});
    list.push_back({"start_speed", "start_speed_m_s", "m/s", nullptr, &ProfileRequest::start_rate});
    list.push_back({"end_speed", "end_speed_m_s", "m/s", nullptr, &ProfileRequest::end_rate});
    return list;
  }();
  return all;
}

/// The value in force: a speed cap on a zone may be lower than the robot's own limit.
double value_of(const ProfileRequest& request, const RelaxableLimit& relaxable) {
  if (relaxable.rate != nullptr) return request.*relaxable.rate;
  const Sided<Motor>& motor = request.plant.robot.motor;
  double value = std::min(limit_of(*relaxable.limit, request.limits, motor, Side::left),
                          limit_of(*relaxable.limit, request.limits, motor, Side::right));
  if (relaxable.name == "speed" && !is_turn(request.piece))
    for (const SpeedCap& cap : request.speed_caps) value = std::min(value, cap.speed_m_s);
  return value;
}

/// The request with a limit raised to at least a value, or an end's speed set to it.
ProfileRequest changed(ProfileRequest request, const RelaxableLimit& relaxable, double value) {
  const auto raise = [&](double& limit) { limit = std::max(limit, value); };
  if (relaxable.rate != nullptr)
    request.*relaxable.rate = value;
  else if (relaxable.limit->field != nullptr)
    raise(request.limits.*relaxable.limit->field);
  else
    for (const Side side : kSides) raise(request.plant.robot.motor[side].*relaxable.limit->rating);
  if (relaxable.name == "speed")
    for (SpeedCap& cap : request.speed_caps) raise(cap.speed_m_s);
  return request;
}

/// Whether a profile passes a grid, or the finer one that the planner tries before it gives up.
bool passes(const ProfileRequest& request, const std::vector<double>& s) {
  const PathMotion motion = path_motion(request);
  const auto passes_on = [&](const std::vector<double>& grid) {
    return !nlp::rate_envelope(nlp::transcribe(request, motion, grid, {}, nullptr)).blocked;
  };
  return passes_on(s) ||
         (!request.draft && passes_on(nlp::cut_segments(s, std::vector<bool>(s.size() - 1, true))));
}

/// Smallest (largest for start and end speeds) value for which a profile exists, to 1e-5 of it and not below
/// 1e-6; none if no value works.
std::optional<double> smallest_relaxation(const ProfileRequest& request, const RelaxableLimit& relaxable,
                                          const std::vector<double>& s) {
  constexpr double kLargest = 1e9, kLeast = 1e-6, kClose = 1e-5;
  const auto possible = [&](double value) { return passes(changed(request, relaxable, value), s); };
  double bad = value_of(request, relaxable), good = relaxable.rate != nullptr ? 0.0 : kLargest;
  if (!possible(good)) return std::nullopt;
  if (relaxable.rate == nullptr) {
    good = std::max(2 * bad, kLeast);
    for (; good < kLargest && !possible(good); good *= 2) bad = good;
    if (bad < kLeast) return good;
  }
  while (std::abs(good - bad) > kClose * std::max(std::abs(good), kLeast)) {
    const double middle = 0.5 * (good + bad);
    (possible(middle) ? good : bad) = middle;
  }
  return good;
}

/// Whether the planner finds a profile in the time that is asked for.
bool plans(const ProfileRequest& request) {
  const std::optional<double> least_s = least_time_found_s(request);
  return least_s && *least_s <= request.time.duration_s * (1 + kMetTime);
}

/// Values that one verdict tries out with the planner, at most.
class Trials {
 public:
  explicit Trials(const ProfileRequest& request) : request_(request) {}

  bool left() const { return made_ < kMost; }

  /// A value with which the planner finds a profile: that of the envelope, else the next one beyond, to 1 %,
  /// or the nearest one tried; nothing where none of those tried works.
  std::optional<double> planned(const RelaxableLimit& relaxable, double value) {
    constexpr double kBeyond[] = {1e-3, 1e-2, 0.1, 0.5, 2};
    constexpr double kClose = 0.01;
    if (possible(relaxable, value)) return value;
    for (const double share : kBeyond) {
      double bad = value, good = relaxable.rate != nullptr ? value / (1 + share) : value * (1 + share);
      if (!possible(relaxable, good)) continue;
      while (left() && std::abs(good - bad) > kClose * std::abs(good)) {
        const double middle = 0.5 * (good + bad);
        (possible(relaxable, middle) ? good : bad) = middle;
      }
      return good;
    }
    return std::nullopt;
  }

 private:
  static constexpr int kMost = 16;

  bool possible(const RelaxableLimit& relaxable, double value) {
    return made_++ < kMost && plans(changed(request_, relaxable, value));
  }

  const ProfileRequest& request_;
  int made_{};
};

const RelaxableLimit* relaxable_limit_named(std::string_view name) {
  for (const RelaxableLimit& relaxable : relaxable_limits())
    if (relaxable.name == name) return &relaxable;
  return nullptr;
}

Infeasibility at_place(const ProfileRequest& request, std::string constraint, double s) {
  const Pose pose = piece_point(request.piece, s).pose;
  return {.constraint = std::move(constraint), .s = s, .x_m = pose.x_m, .y_m = pose.y_m};
}

/// Names of the values to relax, the first one first: a start or end speed that the path does not allow, then
/// the limit itself.
std::vector<std::string_view> relaxations_to_try(const ProfileRequest& request, const nlp::Problem& problem,
                                                 const nlp::Blocked& blocked, std::string_view limit) {
  std::vector<std::string_view> names;
  if (blocked.node == 0 && request.start_rate > 0) names.push_back("start_speed");
  const auto above_cap = [&](double rate, std::size_t node) {
    return rate * rate > problem.cap[node].squared * (1 + 1e-12);
  };
  if (above_cap(request.start_rate, 0)) names.push_back("start_speed");
  if (above_cap(request.end_rate, problem.node_count() - 1)) names.push_back("end_speed");
  names.push_back(limit);
  if (request.end_rate > 0) names.push_back("end_speed");
  if (request.start_rate > 0) names.push_back("start_speed");
  for (const RelaxableLimit& relaxable : relaxable_limits())
    if (relaxable.limit != nullptr && std::isfinite(value_of(request, relaxable)))
      names.push_back(relaxable.name);
  return names;
}

/// The verdict where no single limit can be relaxed enough: the speed that is needed and the one allowed.
Infeasibility too_slow_there(const ProfileRequest& request, std::string_view limit, double s,
                             const nlp::Blocked& blocked) {
  Infeasibility verdict = at_place(request, std::string(limit), s);
  const double needed = std::sqrt(std::max(0.0, blocked.needed));
  const double allowed = std::sqrt(std::max(0.0, blocked.allowed));
  verdict.amount = std::max(0.0, needed - allowed);
  verdict.unit = is_turn(request.piece) ? "rad/s" : "m/s";
  std::ostringstream text;
  text.precision(4);
  text << verdict.constraint << " at s = " << verdict.s << " (x " << verdict.x_m << " m, y " << verdict.y_m
       << " m) allows ";
  if (needed > allowed)
    text << "a speed of " << allowed << " " << verdict.unit << ", but " << needed << " " << verdict.unit
         << " is needed there";
  else
    text << "no motion";
  text << "; no relaxation of a single limit that was tried is sufficient";
  verdict.message = text.str();
  return verdict;
}

}  // namespace

Infeasibility explain_blocked(const ProfileRequest& request, const nlp::Problem& problem,
                              const nlp::Blocked& blocked) {
  std::string_view name = blocked.limit.empty() ? std::string_view("path") : blocked.limit;
  Trials trials(request);
  for (std::string_view candidate : relaxations_to_try(request, problem, blocked, name)) {
    const RelaxableLimit* relaxable = relaxable_limit_named(candidate);
    if (relaxable == nullptr || !trials.left()) continue;
    std::optional<double> value = smallest_relaxation(request, *relaxable, problem.s);
    if (value) value = trials.planned(*relaxable, *value);
    if (!value) continue;
    double s = problem.s[blocked.node];
    if (candidate == "end_speed") s = problem.s.back();
    Infeasibility verdict = at_place(request, std::string(candidate), s);
    verdict.amount = std::abs(*value - value_of(request, *relaxable));
    verdict.unit = relaxable->unit;
    verdict.relaxation[std::string(relaxable->key)] = *value;
    verdict.message = sentence(verdict);
    return verdict;
  }
  return too_slow_there(request, name, problem.s[blocked.node], blocked);
}

void offer_what_plans(const ProfileRequest& request, Infeasibility& verdict) {
  for (const RelaxableLimit& relaxable : relaxable_limits()) {
    const auto offered = verdict.relaxation.find(std::string(relaxable.key));
    if (offered == verdict.relaxation.end()) continue;
    if (const auto value = Trials(request).planned(relaxable, offered->second)) {
      offered->second = *value;
      verdict.amount = std::abs(*value - value_of(request, relaxable));
    } else {
      verdict.relaxation.erase(offered);
    }
    verdict.message = sentence(verdict);
    return;
  }
}

Infeasibility explain_long(const ProfileRequest& request, double possible_s) {
  const bool fixed = request.time.mode == TimeMode::fixed_time;
  Infeasibility verdict = at_place(request, fixed ? "duration" : "deadline", piece_length(request.piece));
  const double asked_s = std::isnan(request.time.duration_s) ? 0.0 : request.time.duration_s;
  verdict.amount = std::abs(possible_s - asked_s);
  verdict.unit = "s";
  verdict.relaxation[fixed ? "duration_s" : "deadline_s"] = possible_s;
  verdict.message = sentence(verdict);
  return verdict;
}

Infeasibility explain_late(const ProfileRequest& request, double least_s) {
  ProfileRequest trial = request;
  trial.time = {.mode = TimeMode::minimum_time};
  const ProfileResult fastest = solve_profile(trial);
  Infeasibility verdict =
      explain_long(request, fastest.profile ? std::max(least_s, fastest.profile->duration_s()) : least_s);
  if (!fastest.profile) return verdict;
  HoldingLimits limits;
  limits.add(request, *fastest.profile);
  verdict.message += limits.sentence();
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
