#include "planner/nlp/fast/jerk_fast_solver.hpp"

#include "planner/nlp/fast/jerk_newton.hpp"
// Design: docs/decisions/0302-jerk.md
namespace joulepath::nlp {
namespace {

constexpr int kMostIterations = 150;
/// First complementarity of every pair, as a share of a segment's part of the objective.
constexpr double kFarGap = 0.1, kNearGap = 1e-2;

JerkSolution solved(const JerkProgram& given, double first_gap, double kink_width) {
  NarrowingKinks kinks(given.problem(), kink_width);
  const JerkProgram program(given, kinks.problem());
  kinks.start(program.squares(), first_gap);
  JerkState state = starting_state(program, first_gap);
  JerkNewton newton(program, state);
  InteriorPoint<JerkNewton> loop(newton, &kinks);
  const FastOutcome outcome = loop.run({.max_iterations = kMostIterations});
  JerkSolution solution{.converged = outcome == FastOutcome::converged,
                        .motion = program.motion(state.x),
                        .objective = loop.open().objective,
                        .price_W = state.time.multiplier(),
                        .iterations = loop.iterations()};
  if (outcome == FastOutcome::iterations_used) solution.message = "no convergence within its iterations";
  if (outcome == FastOutcome::no_descent) solution.message = "no descent";
  return solution;
}

}  // namespace

JerkSolution solve_fast(const JerkProgram& program, JerkStart start) {
  JerkSolution solution;
  int iterations = 0;
  for (const double width : kFinalWidths) {
    solution = solved(program, start == JerkStart::near ? kNearGap : kFarGap, width);
    iterations += solution.iterations;
    if (solution.converged || !has_kinks(program.problem())) break;
  }
  solution.iterations = iterations;
  return solution;
}

}  // namespace joulepath::nlp
