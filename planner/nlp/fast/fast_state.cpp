#include "planner/nlp/fast/fast_state.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::nlp {
namespace {

void add_bounds(FastState& state, const Problem& problem, double mu) {
  for (std::size_t k = 0; k < problem.unknown_count(); ++k) {
    const double b = state.b[k + 1], room = problem.cap[k + 1].squared - b;
    state.low.push_back({.s = b, .y = mu / b});
    state.high.push_back(std::isfinite(room) ? Pair{.s = room, .y = mu / room} : Pair{});
  }
}

void add_rows(FastState& state, const FastModel& model, double mu) {
  const Problem& problem = model.problem();
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const Bounds& bounds = problem.rows[i].bounds;
    const double scale = std::isfinite(bounds.high) ? std::abs(bounds.high) : std::abs(bounds.low);
    for (double sign : {1.0, -1.0}) {
      const double bound = sign > 0 ? bounds.high : bounds.low;
      if (!std::isfinite(bound)) continue;
      const double s = std::max(sign * (bound - model.row(i).value), 1e-3 * scale);
      state.sides.push_back({.row = i,
                             .segment = problem.rows[i].segment,
                             .sign = sign,
                             .bound = bound,
                             .pair = {.s = s, .y = mu / s}});
    }
  }
}

void add_recoveries(FastState& state, const FastModel& model, double mu) {
  const Problem& problem = model.problem();
  for (std::size_t k = 0; k < problem.segment_count(); ++k)
    for (std::size_t c = 0; c < problem.channels; ++c)
      state.recoveries.push_back(
          Recovery::on_central_path(model.jets(k).energy_J[c].value, problem.recovery_weight, mu));
}

}  // namespace

void FastState::reserve(std::size_t nodes, std::size_t rows) {
  b.reserve(nodes);
  low.reserve(nodes);
  high.reserve(nodes);
  sides.reserve(2 * rows);
  recoveries.reserve(2 * nodes);
}

void set_starting_state(FastModel& model, const FastStart& start, FastState& state) {
  const Problem& problem = model.problem();
  state.b.assign(start.b.begin(), start.b.end());
  state.low.clear();
  state.high.clear();
  state.sides.clear();
  state.recoveries.clear();
  for (std::size_t k = 1; k + 1 < state.b.size(); ++k) {
    const double cap = problem.cap[k].squared;
    state.b[k] = std::clamp(state.b[k], std::min(1e-12, 1e-3 * cap), cap * (1 - start.room));
  }
  model.evaluate(state.b);
  const double size = std::max(1e-6, std::abs(model.objective()));
  const double mu = start.gap * size / static_cast<double>(problem.segment_count());
  add_bounds(state, problem, mu);
  add_rows(state, model, mu);
  add_recoveries(state, model, mu);
  state.time = TimeRow::at_start(problem, model.duration_s(), size);
  if (state.time.is_budget() && start.price_W) state.time.slack.y = *start.price_W;
}

}  // namespace joulepath::nlp
