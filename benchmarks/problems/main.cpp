// Writes the public problem set and solves problems of it.
//
//   bench_problems generate PATHS TURNS JERK SEED PROBLEMS.json SOLUTIONS.json ROBOT.yaml...
//   bench_problems solve PROBLEMS.json SOLUTIONS.json [NODES]
// Design: docs/decisions/0803-judges.md
#include <cstdio>
#include <cstring>
#include <fstream>

#include "benchmarks/problems/generator.hpp"
#include "planner/motion/motion_energy.hpp"
#include "planner/profile/profile_solver.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath::problems {
namespace {

constexpr double kAccuracy = 1e-4;

/// Each part of the set has its own stream, so that a part can grow without a change of the others.
struct Stream {
  Part part{};
  std::size_t count{};
  std::size_t samples{};  ///< problems whose solutions the set holds as examples
};

/// A time goal: free (40 %), at most (40 %), exactly (10 %) or least time (10 %).
bool set_time(Generator& random, ProfileRequest& request) {
  const ProfileResult fastest = solve_profile(request);
  const std::size_t draw = random.choice(10);
  const double factor = random.uniform(1.02, 2);
  if (!fastest.profile) return false;
  if (draw == 9) return true;
  request.time = {draw < 4 ? TimeMode::free_time : draw < 8 ? TimeMode::time_budget : TimeMode::fixed_time};
  if (draw >= 4) request.time.duration_s = std::round(factor * fastest.profile->duration_s() * 1e6) / 1e6;
  return true;
}

struct Solved {
  Json best{};
  Json solution{};
};

Solved solve(ProfileRequest request) {
  request.accuracy = kAccuracy;
  const ProfileResult result = solve_profile(request);
  if (!result.profile) return {{{"message", result.summary.message}}, nullptr};
  const bool least = request.time.mode == TimeMode::minimum_time;
  const PathMotion motion = path_motion(request);
  const double energy_J = energy_by_cause(motion, *result.profile).total_J();
  return {{{"value", least ? result.profile->duration_s() : energy_J},
           {"lower_bound", least ? result.summary.lower_bound_s : result.summary.lower_bound_J},
           {"status", solve_status_name(result.summary.status)}},
          solution_json(*result.profile)};
}

/// One entry per line, so that a change of one problem is a change of one line.
void write_lines(std::ofstream& out, const std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < lines.size(); ++i) out << lines[i] << (i + 1 < lines.size() ? ",\n" : "\n");
}

/// Contents of the set's files.
struct Lines {
  std::vector<std::string> problems{}, solutions{};
};

bool append(const Stream& stream, Generator random, Lines& lines) {
  for (std::size_t index = 0; index < stream.count; ++index) {
    Problem problem = random.next(index, stream.part);
    char id[8];
    std::snprintf(id, sizeof id, "p%03zu", lines.problems.size() + 1);
    problem.id = id;
    if (!set_time(random, problem.request)) return false;
    const Solved solved = solve(problem.request);
    if (solved.solution.is_null()) return false;
    Json json = problem_json(problem);
    json["best"] = solved.best;
    lines.problems.push_back(json.dump());
    if (index < stream.samples)
      lines.solutions.push_back(Json(problem.id).dump() + ": " + solved.solution.dump());
    std::fprintf(stderr, "%s %s, bound %.2g below\n", id, problem.kind.c_str(),
                 1 - solved.best["lower_bound"].get<double>() / solved.best["value"].get<double>());
  }
  return true;
}

int generate(const std::vector<Stream>& streams, unsigned seed, const char* problems_file,
             const char* solutions_file, const std::vector<const char*>& robot_files) {
  std::vector<Robot> robots;
  for (const char* file : robot_files) robots.push_back(read_robot(file));
  std::vector<std::string> robot_lines;
  for (const Robot& robot : robots)
    robot_lines.push_back(Json(robot.name).dump() + ": " + robot_json(robot).dump());
  Lines lines;
  for (const Stream& stream : streams)
    if (!append(stream, Generator(seed + static_cast<unsigned>(stream.part), robots), lines)) return 1;
  std::ofstream out(problems_file);
  out << "{\"schema\": \"joulepath/problems/1\",\n\"robots\": {\n";
  write_lines(out, robot_lines);
  out << "},\n\"problems\": [\n";
  write_lines(out, lines.problems);
  out << "]}\n";
  std::ofstream best(solutions_file);
  best << "{\n";
  write_lines(best, lines.solutions);
  best << "}\n";
  return 0;
}

int solve_all(const char* problems_file, const char* solutions_file, std::size_t nodes) {
  Json solutions = Json::object();
  for (Problem& problem : read_problems(problems_file)) {
    problem.request.nodes = nodes;
    problem.request.solver = SolverChoice::fast;
    const Solved solved = solve(problem.request);
    if (!solved.solution.is_null()) solutions[problem.id] = solved.solution;
  }
  std::ofstream(solutions_file) << solutions.dump() << "\n";
  return 0;
}

}  // namespace
}  // namespace joulepath::problems

int main(int argc, char** argv) {
  using namespace joulepath::problems;
  if (argc >= 9 && !std::strcmp(argv[1], "generate"))
    return generate({{Part::paths, std::stoul(argv[2]), 12},
                     {Part::turns, std::stoul(argv[3]), 2},
                     {Part::jerk, std::stoul(argv[4]), 3}},
                    static_cast<unsigned>(std::stoul(argv[5])), argv[6], argv[7], {argv + 8, argv + argc});
  if (argc >= 4 && !std::strcmp(argv[1], "solve"))
    return solve_all(argv[2], argv[3], argc > 4 ? std::stoul(argv[4]) : 200);
  std::fputs(
      "usage: bench_problems generate PATHS TURNS JERK SEED PROBLEMS SOLUTIONS ROBOT... | solve PROBLEMS "
      "SOLUTIONS [NODES]\n",
      stderr);
  return 2;
}
