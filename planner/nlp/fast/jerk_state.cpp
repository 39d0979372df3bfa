#include "planner/nlp/fast/jerk_state.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {
namespace {

constexpr double kRoom = 1e-3;  ///< least distance of a start from its bounds, as a share of their range

/// Calls use(sign, bound) for finite bounds.
template <class Function>
void for_each_side(const Bounds& bounds, Function&& use) {
  if (std::isfinite(bounds.high)) use(1.0, bounds.high);
  if (std::isfinite(bounds.low)) use(-1.0, bounds.low);
}

/// Moves a start inside its bounds. A start near a lower bound of 0 (a rate near a rest end) is kept.
double inside(double x, const Bounds& bounds) {
  constexpr double kLeast = 1e-9;
  const bool both = std::isfinite(bounds.low) && std::isfinite(bounds.high);
  const double room = kRoom * (both ? bounds.high - bounds.low : std::max(1e-6, std::abs(x)));
  const double low = bounds.low + std::min(room, kRoom * std::abs(x - bounds.low) + kLeast);
  return std::clamp(x, std::isfinite(bounds.low) ? low : bounds.low, bounds.high - room);
}

void add_bounds(JerkState& state, const JerkProgram& program, double mu) {
  for (std::size_t i = 0; i < state.x.size(); ++i)
    for_each_side(program.unknown_bounds(i), [&](double sign, double bound) {
      const double s = sign * (bound - state.x[i]);
      state.bounds.push_back({i, sign, bound, {.s = s, .y = mu / s}});
    });
}

void add_rows(JerkState& state, const JerkProgram& program, double mu) {
  constexpr double kLeastScale = 1e-3, kLeastSlack = 1e-3;
  for (std::size_t k = 0; k < state.values.size(); ++k)
    for (std::size_t i = 0; i < program.row_count(k); ++i) {
      const Bounds bounds = program.row_bounds(k, i);
      if (bounds.low == bounds.high) continue;
      const double scale =
          std::max(kLeastScale, std::abs(std::isfinite(bounds.high) ? bounds.high : bounds.low));
      for_each_side(bounds, [&](double sign, double bound) {
        const double s = std::max(sign * (bound - state.values[k].rows[i].value), kLeastSlack * scale);
        state.sides.push_back(
            {.row = i, .segment = k, .sign = sign, .bound = bound, .pair = {.s = s, .y = mu / s}});
      });
    }
}

void add_recoveries(JerkState& state, const Problem& problem, double mu) {
  for (const auto& values : state.values)
    for (std::size_t c = 0; c < problem.channels * JerkProgram::kParts; ++c)
      state.recoveries.push_back(
          Recovery::on_central_path(values.energy_J[c].value, problem.recovery_weight, mu));
}

}  // namespace

void JerkState::evaluate(const JerkProgram& program) {
  const Problem& problem = program.problem();
  objective = duration_s = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    program.evaluate(x.data(), k, values[k]);
    objective += problem.time_weight_W * values[k].duration_s.value;
    for (const JerkJet& part_J : values[k].energy_J) objective += problem.energy_weight * part_J.value;
    duration_s += values[k].duration_s.value;
  }
}

JerkState starting_state(const JerkProgram& program, double gap) {
  const Problem& problem = program.problem();
  JerkState state;
  state.values.resize(problem.segment_count());
  state.lambda.resize(problem.segment_count());
  for (std::size_t i = 0; i < program.unknown_count(); ++i)
    state.x.push_back(inside(program.start(i), program.unknown_bounds(i)));
  state.evaluate(program);
  const double size = std::max(1e-6, std::abs(state.objective));
  const double mu = gap * size / static_cast<double>(problem.segment_count());
  add_bounds(state, program, mu);
  add_rows(state, program, mu);
  add_recoveries(state, problem, mu);
  state.time = TimeRow::at_start(problem, state.duration_s, size);
  return state;
}

}  // namespace joulepath::nlp
