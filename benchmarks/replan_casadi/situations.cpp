// The replanner's answers to seeded random situations on problems of the public set, as JSON for a peer.
//
//   bench_replan_situations PROBLEMS.json OUT.json SEED SITUATIONS NODES SLACK
#include "extensions/onboard/tests/situations.hpp"

#include <cstdio>
#include <fstream>
#include <string>

#include "benchmarks/problems/problem.hpp"
#include "planner/nlp/fast/thread_clock.hpp"

namespace joulepath::problems {
namespace {

Json answered(Replanner& replanner, const Situation& situation) {
  const double before_s = nlp::thread_cpu_s();
  const Replan& replan = replanner.replan(situation);
  const double spent_s = nlp::thread_cpu_s() - before_s;
  return {{"s", situation.s},
          {"rate", situation.rate},
          {"time_left_s", situation.time_left_s},
          {"ms", 1e3 * spent_s},
          {"status", replan_status_name(replan.status)},
          {"s_m", replan.profile->s},
          {"rates", replan.profile->rate}};
}

/// Situations that a profile leads on from in time, along the plan.
Json answers(const testing::PlannedPiece& piece, testing::RandomProfiles& random, int count,
             std::size_t nodes) {
  Replanner replanner(piece.request, piece.plan, nodes);
  Json list = Json::array();
  const double duration_s = piece.plan.time_s.back();
  for (int i = 0; i < count; ++i) {
    const double time_s = duration_s * (0.05 + 0.8 * i / count);
    const ProfileState state = piece.plan.at_time(time_s);
    const Situation situation{.s = state.s,
                              .rate = state.rate * random.uniform(0.85, 1.0),
                              .payload_kg = piece.request.payload.from_kg,
                              .time_left_s = (duration_s - time_s) * random.uniform(0.97, 1.1)};
    Json answer = answered(replanner, situation);
    if (answer["status"] == "optimal") list.push_back(std::move(answer));
  }
  return list;
}

}  // namespace
}  // namespace joulepath::problems

int main(int argc, char** argv) {
  using namespace joulepath;
  if (argc < 7)
    return std::fputs("usage: bench_replan_situations PROBLEMS OUT SEED SITUATIONS NODES SLACK\n", stderr), 2;
  testing::RandomProfiles random(static_cast<unsigned>(std::stoul(argv[3])));
  problems::Json all = problems::Json::object();
  for (const problems::Problem& problem : problems::read_problems(argv[1]))
    if (const auto piece = testing::planned(problem.request, std::stod(argv[6])))
      all[problem.id] = problems::answers(*piece, random, std::stoi(argv[4]), std::stoul(argv[5]));
  std::ofstream(argv[2]) << all.dump() << "\n";
  return 0;
}
