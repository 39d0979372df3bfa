// The program's side of the comparison with its peers: problems in, solutions and CPU times out, as JSON.
//
//   bench_peers plan PROBLEMS.json OUT.json NODES      whole solves of the product
//   bench_peers programs PROBLEMS.json OUT.json NODES  one nonlinear program on a fixed grid, by both solvers
//   bench_peers baselines PROBLEMS.json OUT.json       classic profiles in the time of the optimum
#include <cstdio>
#include <cstring>
#include <fstream>

#include "benchmarks/problems/problem.hpp"
#include "benchmarks/support/cpu_time.hpp"
#include "benchmarks/support/prepared_problem.hpp"
#include "planner/baselines/baseline.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/profile/profile_solver.hpp"

namespace joulepath::problems {
namespace {

Json plan(ProfileRequest request, std::size_t nodes) {
  request.nodes = nodes;
  Json json;
  const double start_ms = cpu_ms();
  const ProfileResult result = solve_profile(request);
  json["solve_ms"] = cpu_ms() - start_ms;
  json["status"] = solve_status_name(result.summary.status);
  json["lower_bound_J"] = result.summary.lower_bound_J;
  json["lower_bound_s"] = result.summary.lower_bound_s;
  json["message"] = result.summary.message;
  if (result.profile) json["solution"] = solution_json(*result.profile);
  return json;
}

Json solved_json(const nlp::Problem& problem, const nlp::Solution& solution, double solve_ms) {
  return {{"solve_ms", solve_ms},
          {"converged", solution.converged},
          {"iterations", solution.iterations},
          {"solution", solution_json(profile_from_squares(problem.s, solution.b))}};
}

Json programs(const ProfileRequest& request, std::size_t nodes) {
  double start_ms = cpu_ms();
  const PreparedProblem prepared(request, nodes);
  Json json{{"prepare_ms", cpu_ms() - start_ms}};
  start_ms = cpu_ms();
  const nlp::Solution fast = nlp::solve_fast(prepared.problem, prepared.guess);
  json["fast"] = solved_json(prepared.problem, fast, cpu_ms() - start_ms);
  start_ms = cpu_ms();
  const nlp::Solution ipopt = nlp::solve_with_ipopt(prepared.problem, prepared.guess);
  json["ipopt"] = solved_json(prepared.problem, ipopt, cpu_ms() - start_ms);
  return json;
}

Json classic(const ProfileRequest& request) {
  const ProfileResult optimum = solve_profile(request);
  if (!optimum.profile) return {{"message", optimum.summary.message}};
  Json json{{"optimum", solution_json(*optimum.profile)}};
  for (const BaselineResult& result : all_baselines(request, optimum.profile->duration_s()))
    if (result.feasible && result.profile) json[result.name] = solution_json(*result.profile);
  return json;
}

}  // namespace
}  // namespace joulepath::problems

int main(int argc, char** argv) {
  using namespace joulepath::problems;
  if (argc < 4)
    return std::fputs("usage: bench_peers plan|programs|baselines PROBLEMS OUT [NODES]\n", stderr), 2;
  const std::size_t nodes = argc > 4 ? std::stoul(argv[4]) : 200;
  Json answers = Json::object();
  for (Problem& problem : read_problems(argv[2])) {
    problem.request.solver = joulepath::SolverChoice::fast;
    const bool is_plan = !std::strcmp(argv[1], "plan"), is_program = !std::strcmp(argv[1], "programs");
    answers[problem.id] = is_plan      ? plan(problem.request, nodes)
                          : is_program ? programs(problem.request, nodes)
                                       : classic(problem.request);
  }
  std::ofstream(argv[3]) << answers.dump() << "\n";
  return 0;
}
