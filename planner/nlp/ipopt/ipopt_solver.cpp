// Design: docs/decisions/0301-solvers.md
#include "planner/nlp/ipopt/ipopt_solver.hpp"

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <mutex>

#include "planner/nlp/ipopt/ipopt_nlp.hpp"
#include "planner/nlp/transcription/squares_program.hpp"

// Method: [WaechterBiegler2006]
namespace joulepath::nlp {
namespace {

/// First barrier parameter: of a cold start, near the solution, and with the multipliers of another solver.
/// The last is that solver's own: a larger one leads away from the solution and back.
constexpr double kColdMu = 0.1, kWarmMu = 1e-6, kNearMu = 1e-11;

/// On fine grids rounding ends the steps before the tolerance is met: from multipliers of a solution, this
/// many iterations with at most this error are enough.
constexpr double kRoundingError = 1e-8;
constexpr int kRoundingIterations = 3;

double first_mu(const IpoptOptions& options) {
  if (options.near != nullptr) return kNearMu;
  return options.warm ? kWarmMu : kColdMu;
}

void set_options(Ipopt::OptionsList& ipopt, const IpoptOptions& options) {
  ipopt.SetIntegerValue("print_level", 0);
  ipopt.SetStringValue("sb", "yes");
  ipopt.SetNumericValue("tol", options.tolerance);
  ipopt.SetIntegerValue("max_iter", options.max_iterations);
  ipopt.SetIntegerValue("mumps_pivot_order", 6);
  ipopt.SetNumericValue("bound_relax_factor", 0.0);
  ipopt.SetStringValue("honor_original_bounds", "yes");
  // MUMPS takes most of the time, so the settings reduce the number of solves, and intermediate barrier
  // problems are solved only as accurately as the next one needs.
  ipopt.SetStringValue("fast_step_computation", "yes");
  ipopt.SetIntegerValue("min_refinement_steps", 0);
  ipopt.SetNumericValue("barrier_tol_factor", 300.0);
  ipopt.SetNumericValue("mu_superlinear_decrease_power", 1.8);
  ipopt.SetNumericValue("mu_init", first_mu(options));
  if (!options.warm) return;
  for (const char* push : {"bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"}) {
    ipopt.SetNumericValue(push, 1e-8);
    if (options.near != nullptr) ipopt.SetNumericValue(std::string("warm_start_") + push, 1e-8);
  }
  if (options.near == nullptr) return;
  ipopt.SetNumericValue("acceptable_tol", kRoundingError);
  ipopt.SetIntegerValue("acceptable_iter", kRoundingIterations);
  ipopt.SetStringValue("warm_start_init_point", "yes");
  ipopt.SetNumericValue("warm_start_mult_bound_push", 1e-8);
}

template <SegmentProgram Program>
ProgramSolution solve(const Program& program, const IpoptOptions& options) {
  ProgramSolution solution;
  Ipopt::SmartPtr<Ipopt::IpoptApplication> app = new Ipopt::IpoptApplication(false);
  set_options(*app->Options(), options);
  if (app->Initialize("") != Ipopt::Solve_Succeeded) {
    solution.message = "ipopt does not start";
    return solution;
  }
  Ipopt::SmartPtr<Ipopt::TNLP> nlp =
      new IpoptNlp<Program>(program, solution, first_mu(options), options.near);
  static std::mutex one_at_a_time;  // MUMPS keeps global state between calls
  const std::lock_guard lock(one_at_a_time);
  const Ipopt::ApplicationReturnStatus status = app->OptimizeTNLP(nlp);
  if (Ipopt::IsValid(app->Statistics())) solution.iterations = app->Statistics()->IterationCount();
  if (!solution.converged)
    solution.message = "ipopt stopped with code " + std::to_string(static_cast<int>(status));
  return solution;
}

}  // namespace

Solution solve_with_ipopt(const Problem& problem, const std::vector<double>& b_guess,
                          const IpoptOptions& options) {
  ProgramSolution found = solve(SquaresProgram(problem, b_guess), options);
  Solution solution{.converged = found.converged,
                    .b = b_guess,
                    .z = std::move(found.z),
                    .objective = found.objective,
                    .price_W = found.price_W,
                    .row_multiplier = std::move(found.row_multiplier),
                    .recovery_multiplier = std::move(found.recovery_multiplier),
                    .iterations = found.iterations,
                    .message = std::move(found.message)};
  for (std::size_t i = 0; i < found.x.size(); ++i)
    solution.b[i + 1] = std::clamp(found.x[i], 0.0, problem.cap[i + 1].squared);
  return solution;
}

JerkSolution solve_with_ipopt(const JerkProgram& program, const IpoptOptions& options) {
  const ProgramSolution found = solve(program, options);
  JerkSolution solution{.converged = found.converged,
                        .objective = found.objective,
                        .price_W = found.price_W,
                        .iterations = found.iterations,
                        .message = found.message};
  if (!found.x.empty()) solution.motion = program.motion(found.x);
  return solution;
}

}  // namespace joulepath::nlp
