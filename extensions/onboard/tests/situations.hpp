#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "extensions/onboard/replan/replanner.hpp"
#include "model/limit_table.hpp"
#include "planner/motion/limit_check.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/profile/first_guess.hpp"
#include "planner/profile/profile_solver.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath::testing {

struct PlannedPiece {
  ProfileRequest request;
  Profile plan{};
};

/// A piece and its plan; the time is `slack` times the least one, or free.
inline std::optional<PlannedPiece> planned(ProfileRequest request, std::optional<double> slack) {
  request.solver = SolverChoice::fast;
  request.time = {TimeMode::minimum_time};
  const ProfileResult fastest = solve_profile(request);
  if (!fastest.profile) return std::nullopt;
  request.time = slack ? TimeGoal{TimeMode::time_budget, *slack * fastest.profile->duration_s()}
                       : TimeGoal{TimeMode::free_time};
  const ProfileResult result = solve_profile(request);
  if (!result.profile) return std::nullopt;
  return PlannedPiece{request, *result.profile};
}

/// The request that a situation asks for, written down afresh.
inline ProfileRequest asked(const PlannedPiece& piece, const Situation& situation) {
  ProfileRequest request = piece.request;
  const PathMotion motion = path_motion(piece.request);
  const double extra_kg = situation.payload_kg - motion.payload_kg(situation.s);
  request.payload.from_kg += extra_kg;
  request.payload.to_kg += extra_kg;
  if (extra_kg != 0)
    request.limits =
        limits_between_payloads(request.plant.robot, request.payload.from_kg, request.payload.to_kg);
  request.start_rate = situation.rate;
  for (const SpeedCap& cap : situation.speed_caps) request.speed_caps.push_back(cap);
  request.time = std::isfinite(situation.time_left_s) ? TimeGoal{TimeMode::time_budget, situation.time_left_s}
                                                      : TimeGoal{TimeMode::free_time};
  return request;
}

/// The optimum of what is left, without any table: transcribed afresh on a finer grid.
struct Judgment {
  bool possible{};
  double least_time_s{};
  std::optional<double> energy_J{};  ///< of the optimum in the time asked for
};

/// Exact energy (J) of a profile that begins anywhere on the piece, standby included.
inline double exact_energy_J(const PathMotion& motion, const Profile& profile) {
  double sum_J = motion.plant().robot.power.standby_W * profile.time_s.back();
  for (std::size_t k = 0; k + 1 < profile.s.size(); ++k)
    if (profile.s[k + 1] > profile.s[k]) sum_J += segment_energy_J(motion, profile, k);
  return sum_J;
}

inline Judgment judge(const ProfileRequest& request, double s0, std::size_t nodes = 800) {
  const PathMotion motion = path_motion(request);
  std::vector<double> s{s0};
  for (const double node : nlp::make_grid(motion, request, nodes))
    if (node > s0 + 1e-6 * motion.length()) s.push_back(node);
  nlp::Problem problem = nlp::transcribe(request, motion, s, {}, nullptr);
  const nlp::RateEnvelope envelope = nlp::rate_envelope(problem);
  if (envelope.blocked) return {};
  Judgment judgment{.possible = true, .least_time_s = nlp::duration_of(problem, envelope.fastest)};
  const bool timed = problem.duration_row != nlp::DurationRow::none;
  if (timed && problem.duration_s <= judgment.least_time_s * (1 + 1e-5)) return judgment;
  const double aim_s = timed ? 0.9 * problem.duration_s + 0.1 * judgment.least_time_s : kNoLimit;
  const std::vector<double> start =
      first_guess(problem, envelope, std::min(aim_s, 1.5 * judgment.least_time_s));
  const nlp::Solution solution = nlp::solve_fast(problem, start);
  if (solution.converged) judgment.energy_J = exact_energy_J(motion, profile_from_squares(s, solution.b));
  return judgment;
}

/// Largest use of any limit of a request along a profile, between nodes too; 1 is the limit.
inline double worst_use(const ProfileRequest& request, const Profile& profile,
                        std::string_view* which = nullptr) {
  const PathMotion motion = path_motion(request);
  double worst = 0;
  for (std::size_t k = 0; k + 1 < profile.s.size(); ++k)
    for (double share : {1e-6, 0.25, 0.5, 0.75, 1 - 1e-6}) {
      const double dt = profile.time_s[k + 1] - profile.time_s[k];
      const ProfileState state = profile.at_time(profile.time_s[k] + share * dt);
      for_each_limit_use(motion, request.limits, request.speed_caps, state, 0.0,
                         [&](std::string_view name, double ratio) {
                           if (ratio <= worst) return;
                           worst = ratio;
                           if (which) *which = name;
                         });
    }
  return worst;
}

/// A random situation on a planned piece: off the plan by up to 20 % of its rate, another payload, less or
/// more time, perhaps a new speed limit ahead.
class RandomSituations {
 public:
  explicit RandomSituations(unsigned seed) : random_(seed) {}

  Situation next(const PlannedPiece& piece) {
    const PathMotion motion = path_motion(piece.request);
    const double length = motion.length();
    const double time_s = piece.plan.time_s.back() * random_.uniform(0.02, 0.9);
    const ProfileState state = piece.plan.at_time(time_s);
    Situation situation{.s = std::min(state.s * random_.uniform(0.97, 1.0), 0.98 * length),
                        .rate = state.rate * random_.uniform(0.8, 1.05),
                        .payload_kg = motion.payload_kg(state.s)};
    if (random_.choice(3) == 0)
      situation.payload_kg = std::min(situation.payload_kg * random_.uniform(0.0, 1.3),
                                      payload_limit_kg(piece.request.plant.robot));
    if (piece.request.time.mode == TimeMode::time_budget)
      situation.time_left_s = (piece.request.time.duration_s - time_s) * random_.uniform(0.95, 1.1);
    if (random_.choice(4) == 0) {
      const double from = random_.uniform(situation.s, length);
      cap_ = {from, from + random_.uniform(0.05, 0.3) * length, random_.uniform(0.2, 0.8)};
      situation.speed_caps = {&cap_, 1};
    }
    return situation;
  }

 private:
  RandomProfiles random_;
  SpeedCap cap_{};
};

}  // namespace joulepath::testing
