#include "planner/profile/costate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/nlp/transcription/segment_jets.hpp"

namespace joulepath {
namespace {

using nlp::Jet;
using nlp::Problem;
using nlp::Solution;

constexpr double kAtCap = 1 - 1e-5;  ///< share of the cap's square from which a cap holds the rate
constexpr double kFaster = 1e-4;     ///< relative: excess of a rate where a limit does not bind
constexpr double kSomething = 1e-9;  ///< of the costate: a smaller step at a node is rounding

/// Derivatives of a segment's part of the Lagrangian by the squares of the rate at its ends. The part of rows
/// at the ends that depends on the square there, at a given acceleration, belongs to the node: it holds at
/// one place.
struct SegmentSlopes {
  std::array<double, 2> inside{};
  std::array<double, 2> at_node{};
};

void add_rows(const Problem& problem, const Solution& solution, std::size_t k, SegmentSlopes& slopes) {
  if (problem.first_row[k] == problem.first_row[k + 1]) return;
  const nlp::Interval<Jet> interval =
      nlp::jet_interval(problem.segments[k], solution.b[k], solution.b[k + 1]);
  nlp::Interval<Jet> steady = interval;
  steady.a = Jet(interval.a.value);
  for (std::size_t i = problem.first_row[k]; i < problem.first_row[k + 1]; ++i) {
    const double y = solution.row_multiplier[i];
    if (y == 0) continue;
    const Jet row = evaluate_row(problem, problem.rows[i], interval);
    const Jet held = evaluate_row(problem, problem.rows[i], steady);
    const bool at_end = held.d[0] == 0 || held.d[1] == 0;
    for (std::size_t end : {0, 1}) {
      slopes.inside[end] += y * (row.d[end] - (at_end ? held.d[end] : 0.0));
      slopes.at_node[end] += y * (at_end ? held.d[end] : 0.0);
    }
  }
}

SegmentSlopes slopes_of(const Problem& problem, const Solution& solution, std::size_t k) {
  const nlp::SegmentJets jets = nlp::segment_jets(problem.segments[k], solution.b[k], solution.b[k + 1]);
  Jet sum = (problem.time_weight_W + solution.price_W) * jets.duration_s;
  for (std::size_t c = 0; c < 2; ++c) {
    double weight = problem.energy_weight;
    if (c < problem.channels)
      weight -=
          std::clamp(solution.recovery_multiplier[k * problem.channels + c], 0.0, problem.recovery_weight);
    sum += weight * jets.energy_J[c];
  }
  SegmentSlopes slopes{.inside = sum.d};
  add_rows(problem, solution, k, slopes);
  return slopes;
}

/// psi at a rest end: the Hamiltonian H - psi a is 0 there.
double psi_at_rest(const CostModel& model, double s, double time_s, double acceleration) {
  const double H = PlaceCost(model, s, time_s).at(0.0, acceleration);
  return acceleration != 0 ? H / acceleration : 0.0;
}

/// Mean over the time of dH/da at rest.
double mean_slope_at_rest(const CostModel& model, const Profile& profile) {
  constexpr double kStep = 1e-3;  // of acceleration: the power is quadratic
  constexpr std::size_t kSamples = 20;
  double sum = 0;
  for (std::size_t i = 0; i < kSamples; ++i) {
    const ProfileState state =
        profile.at_time(profile.time_s.back() * (static_cast<double>(i) + 0.5) / kSamples);
    const PlaceCost place(model, state.s, state.time_s);
    sum += (place.at(0, kStep) - place.at(0, -kStep)) / (2 * kStep * kSamples);
  }
  return sum;
}

/// Distributes the steps of neighboring nodes on a cap over the segment between them.
void spread_jumps(const std::vector<bool>& held, const std::vector<double>& jump, std::vector<double>& start,
                  std::vector<double>& end) {
  const auto share = [&](std::size_t k) {  // of a node's step, for one of its segments
    return held[k - 1] && held[k + 1] ? 0.5 * jump[k] : jump[k];
  };
  for (std::size_t k = 1; k + 1 < start.size(); ++k) {
    if (!held[k] || !held[k + 1] || jump[k] * jump[k + 1] <= 0) continue;
    const double first = share(k), second = share(k + 1);
    const double spread = std::copysign(std::min(std::abs(first), std::abs(second)), first);
    start[k] -= spread;
    end[k] += spread;
  }
}

/// Whether no profile can be faster at a node: a cap holds there, or a limit that permits no acceleration.
bool is_fastest(const CostModel& model, const Profile& profile, std::size_t k) {
  const double faster = profile.rate[k] * (1 + kFaster), inset = 1e-9 * profile.s.back();
  for (double s : {profile.s[k] - inset, profile.s[k] + inset}) {
    const PlaceCost place(model, s, profile.time_s[k]);
    if (faster > place.fastest() || !(place.least(faster, 0.0) < kNoLimit)) return true;
  }
  return false;
}

}  // namespace

Costate costate_of(const Problem& problem, const Solution& solution, const Profile& profile,
                   const CostModel& model, bool priced_rate) {
  const std::size_t count = problem.segment_count();
  const double of_rate = priced_rate ? mean_slope_at_rest(model, profile) : 0.0;
  std::vector<double> start(count), end(count), jump(count + 1, 0.0);
  std::vector<bool> held(count + 1, false);
  for (std::size_t k = 0; k < count; ++k) {
    const SegmentSlopes slopes = slopes_of(problem, solution, k);
    start[k] = -slopes.inside[0];
    end[k] = slopes.inside[1];
    for (std::size_t i : {0, 1})
      if (std::abs(slopes.at_node[i]) > kSomething * std::abs(slopes.inside[i])) held[k + i] = true;
  }
  held.front() = held.back() = false;
  for (std::size_t k = 1; k < count; ++k) {
    if (solution.b[k] >= kAtCap * problem.cap[k].squared) held[k] = true;
    jump[k] = start[k] - end[k - 1];
    if (held[k]) continue;
    start[k] = end[k - 1] = 0.5 * (start[k] + end[k - 1]);
    jump[k] = 0;
  }
  spread_jumps(held, jump, start, end);
  for (std::size_t k = 1; k < count; ++k) {
    if (held[k] && !is_fastest(model, profile, k)) start[k] = end[k - 1] = 0.5 * (start[k] + end[k - 1]);
    jump[k] = start[k] - end[k - 1];
  }
  Costate costate{.psi_start = start, .psi_end = end, .jump = jump, .of_rate = of_rate};
  for (std::size_t k = 0; k < count; ++k) {
    costate.psi_start[k] *= 2 * profile.rate[k];
    costate.psi_end[k] *= 2 * profile.rate[k + 1];
  }
  const double inset = 1e-7;
  if (profile.rate.front() == 0)
    costate.psi_start.front() = psi_at_rest(model, inset * profile.s[1], 0.0, profile.acceleration.front());
  if (profile.rate.back() == 0)
    costate.psi_end.back() =
        psi_at_rest(model, profile.s.back() - inset * (profile.s.back() - profile.s[count - 1]),
                    profile.time_s.back(), profile.acceleration.back());
  return costate;
}

}  // namespace joulepath
