#include "extensions/onboard/replan/replanner.hpp"

#include <algorithm>
#include <cmath>

#include "extensions/onboard/replan/emergency_stop.hpp"
#include "model/limit_table.hpp"
#include "planner/nlp/fast/thread_clock.hpp"

namespace joulepath {
namespace {

using nlp::FastOutcome;
using nlp::Problem;
using nlp::RateEnvelope;

constexpr double kTolerance = 1e-6;  ///< of the energy on the grid
constexpr double kSameTime = 2e-6;   ///< relative: a deadline this close to the least time leaves no choice
constexpr double kColdGap = 0.3, kColdRoom = 1e-6;  ///< see FastStart
constexpr double kWarmGap = 0.05, kWarmRoom = 1e-3;
constexpr int kWarmIterations = 25;  ///< a warm start that takes longer began too near to a wrong limit
constexpr double kWithin = 1e-7;     ///< relative: what a limit may be exceeded by
constexpr double kNoRoom = 1e-4;     ///< relative to the piece: nothing to drive before a blocked place
constexpr int kRetreatHalvings = 16;
constexpr double kInside = 0.9999;  ///< of the fastest squares, for a guess

/// Squares between the slowest (share 0) and the fastest.
void blend(const RateEnvelope& envelope, double share, std::vector<double>& b) {
  b.resize(envelope.fastest.size());
  for (std::size_t k = 0; k < b.size(); ++k)
    b[k] = share * envelope.fastest[k] + (1 - share) * envelope.slowest[k];
  b.front() = envelope.fastest.front();
  b.back() = envelope.fastest.back();
}

/// Energy (J) of squares of the rate, standby included.
double energy_J(const Problem& problem, const std::vector<double>& b) {
  double sum_J = 0;
  const double standby_W = problem.request->plant.robot.power.standby_W;
  for (std::size_t k = 0; k < problem.segment_count(); ++k) {
    const auto interval = nlp::plain_interval(problem.segments[k], b[k], b[k + 1]);
    sum_J += nlp::kept_energy_J(interval) + standby_W * interval.dt;
  }
  return sum_J;
}

}  // namespace

const char* replan_status_name(ReplanStatus status) {
  constexpr const char* kNames[] = {"optimal", "feasible", "late", "stopping"};
  return kNames[static_cast<std::size_t>(status)];
}

Replanner::Replanner(const ProfileRequest& request, const Profile& plan, std::size_t nodes)
    : problem_(request, plan, nodes), last_s_(plan.s) {
  for (const double rate : plan.rate) last_b_.push_back(rate * rate);
  const std::size_t most = problem_.most_nodes();
  sweeps_.reserve(most);
  solver_.reserve(most, problem_.most_rows());
  for (auto* numbers : {&b_, &guess_, &s_, &last_s_, &last_b_, &profile_.time_s, &profile_.s, &profile_.rate,
                        &profile_.acceleration, &profile_.jerk})
    numbers->reserve(most);
}

const Replan& Replanner::replan(const Situation& situation, const ReplanBudget& budget) {
  const double until_cpu_s = std::isfinite(budget.cpu_s) ? nlp::thread_cpu_s() + budget.cpu_s : kNoLimit;
  answer_ = {.profile = &profile_, .gap_percent = std::nan("")};
  if (situation.rate <= 0 && situation.stop_at - situation.s <= kNoRoom * length()) {
    stand(situation);
    return answer_;
  }
  problem_.set(situation, price_W_);
  if (problem_.overloaded()) {
    stop(situation, {.limit = payload_limit().name});
    return answer_;
  }
  const Problem& problem = problem_.problem();
  if (problem_.raised_until() > situation.s) answer_.above_cap_until = problem_.raised_until();
  const RateEnvelope& envelope = sweeps_.run(problem);
  if (envelope.blocked) {
    stop(situation, *envelope.blocked);
    return answer_;
  }
  s_.assign(problem.s.begin(), problem.s.end());
  const double least_s = nlp::duration_of(problem, envelope.fastest);
  const bool timed = problem.duration_row != nlp::DurationRow::none;
  if (problem.unknown_count() == 0 || (timed && problem.duration_s <= least_s * (1 + kSameTime))) {
    b_.assign(envelope.fastest.begin(), envelope.fastest.end());
    answer_.late_s = timed ? std::max(0.0, least_s - problem.duration_s) : 0.0;
    const bool late = answer_.late_s > kSameTime * least_s;
    answer_.status = late ? ReplanStatus::late : ReplanStatus::optimal;
    if (!late) answer_.gap_percent = 0, answer_.late_s = 0;
  } else {
    optimize(envelope, budget, until_cpu_s);
  }
  finish(situation);
  remember();
  return answer_;
}

void Replanner::optimize(const RateEnvelope& envelope, const ReplanBudget& budget, double until_cpu_s) {
  const Problem& problem = problem_.problem();
  nlp::FastOptions options{kTolerance, std::min(budget.iterations, kWarmIterations), until_cpu_s};
  guess(envelope);
  FastOutcome outcome = solver_.solve(problem, {guess_, kWarmGap, kWarmRoom, {}}, options);
  answer_.iterations = solver_.iterations();
  const bool stuck = outcome == FastOutcome::no_descent || outcome == FastOutcome::iterations_used;
  options.max_iterations = budget.iterations - answer_.iterations;
  if (stuck && options.max_iterations > 0) {
    blend(envelope, 0.5, guess_);
    outcome = solver_.solve(problem, {guess_, kColdGap, kColdRoom, {}}, options);
    answer_.iterations += solver_.iterations();
  }
  b_.assign(solver_.state().b.begin(), solver_.state().b.end());
  if (outcome == FastOutcome::converged) {
    answer_.status = ReplanStatus::optimal;
    answer_.gap_percent = 100 * solver_.error();
    price_W_ = solver_.state().time.multiplier();
    answer_.price_of_time_W = price_W_;
  } else {
    answer_.status = ReplanStatus::feasible;
    retreat(envelope);
  }
}

/// The last profile at the new nodes, between the slowest and the fastest.
void Replanner::guess(const RateEnvelope& envelope) {
  const Problem& problem = problem_.problem();
  guess_.resize(problem.node_count());
  for (std::size_t k = 0; k < guess_.size(); ++k) {
    const double slowest = envelope.slowest[k], room = kInside * (envelope.fastest[k] - slowest);
    guess_[k] = std::clamp(remembered(problem.s[k]), slowest + (1 - kInside) * room, slowest + room);
  }
  guess_.front() = problem.b_start;
  guess_.back() = problem.b_end;
}

/// From an iterate that may exceed limits back towards the fastest profile, which keeps them all, as far as
/// needed: limits leave a convex set, but for rows of voltage and power.
void Replanner::retreat(const RateEnvelope& envelope) {
  guess_.assign(b_.begin(), b_.end());
  double low = 0, high = 1;
  const auto towards = [&](double share) {
    for (std::size_t k = 0; k < b_.size(); ++k)
      b_[k] = envelope.fastest[k] + share * (guess_[k] - envelope.fastest[k]);
    return keeps_everything(b_);
  };
  if (towards(1)) return;
  for (int i = 0; i < kRetreatHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (towards(middle) ? low : high) = middle;
  }
  (void)towards(low);
}

bool Replanner::keeps_everything(const std::vector<double>& b) const {
  const Problem& problem = problem_.problem();
  for (std::size_t k = 0; k < problem.segment_count(); ++k) {
    if (!(b[k] >= 0) || b[k] > problem.cap[k].squared * (1 + kWithin)) return false;
    const auto interval = nlp::plain_interval(problem.segments[k], b[k], b[k + 1]);
    for (std::size_t i = problem.first_row[k]; i < problem.first_row[k + 1]; ++i) {
      const nlp::ActiveRow& row = problem.rows[i];
      const double value = nlp::evaluate_row(problem, row, interval);
      if (value > row.bounds.high + kWithin * std::abs(row.bounds.high)) return false;
      if (value < row.bounds.low - kWithin * std::abs(row.bounds.low)) return false;
    }
  }
  return nlp::duration_of(problem, b) <= problem.duration_s * (1 + kSameTime);
}

/// No profile leads on: brakes.
void Replanner::stop(const Situation& situation, const nlp::Blocked& blocked) {
  answer_.status = ReplanStatus::stopping;
  answer_.limit = blocked.limit;
  const double room = problem_.problem().s[blocked.node] - problem_.problem().s.front();
  if (situation.stop_at < length()) {  // the way on is needed: it may not stop before
    Situation open = situation;
    open.stop_at = kNoLimit;
    problem_.set(open, price_W_);
  }
  emergency_stop(problem_.problem(), room, s_, b_);
  finish(situation);
  const double end = std::min(situation.stop_at, length());
  answer_.overrun = std::max(0.0, profile_.s.back() - end);
}

/// Nothing to drive.
void Replanner::stand(const Situation& situation) {
  answer_.status = ReplanStatus::optimal;
  answer_.gap_percent = 0;
  s_.assign(2, situation.s);
  b_.assign(2, 0.0);
  profile_from_nodes();
}

/// The executable profile of the squares b_ at the nodes s_.
void Replanner::profile_from_nodes() {
  profile_.time_s.assign(1, 0.0);
  profile_.s.assign(s_.begin(), s_.end());
  profile_.rate.clear();
  profile_.acceleration.clear();
  for (const double b : b_) profile_.rate.push_back(std::sqrt(std::max(0.0, b)));
  for (std::size_t k = 0; k + 1 < s_.size(); ++k) {
    const double ds = s_[k + 1] - s_[k], sum = profile_.rate[k] + profile_.rate[k + 1];
    profile_.acceleration.push_back(ds > 0 ? (b_[k + 1] - b_[k]) / (2 * ds) : 0.0);
    profile_.time_s.push_back(profile_.time_s.back() + (sum > 0 ? 2 * ds / sum : 0.0));
  }
  profile_.jerk.assign(profile_.acceleration.size(), 0.0);
  answer_.duration_s = profile_.time_s.back();
}

void Replanner::finish(const Situation& situation) {
  profile_from_nodes();
  if (answer_.status != ReplanStatus::stopping)
    answer_.energy_J = energy_J(problem_.problem(), b_);
  else if (std::isfinite(situation.time_left_s))
    answer_.late_s = kNoLimit;
}

void Replanner::remember() {
  last_s_.assign(s_.begin(), s_.end());
  last_b_.assign(b_.begin(), b_.end());
}

double Replanner::remembered(double s) const {
  const auto after = std::upper_bound(last_s_.begin(), last_s_.end(), s);
  if (after == last_s_.begin()) return last_b_.front();
  if (after == last_s_.end()) return last_b_.back();
  const auto k = static_cast<std::size_t>(after - last_s_.begin());
  const double share = (s - last_s_[k - 1]) / (last_s_[k] - last_s_[k - 1]);
  return last_b_[k - 1] + share * (last_b_[k] - last_b_[k - 1]);
}

}  // namespace joulepath
