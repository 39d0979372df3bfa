// The replanner on seeded random situations: CPU time of the calling thread, energy and deadline against the
// optimum that is transcribed afresh, limits between nodes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

#include "extensions/onboard/tests/situations.hpp"
#include "planner/nlp/fast/thread_clock.hpp"

namespace joulepath {
namespace {

constexpr unsigned kSeed = 20261122;
constexpr int kPieces = 40;
constexpr int kCallsAPiece = 50;     ///< before the next one: its tables leave the cache as on a robot
constexpr double kAllowed_s = 0.05;  ///< of lateness

std::string format(const char* pattern, auto... values) {
  char text[500];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

struct Sample {
  std::vector<double> values{};
  double share(double q) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
  }
};

struct Piece {
  testing::PlannedPiece planned;
  Replanner replanner;
  testing::RandomSituations situations;
};

std::vector<std::unique_ptr<Piece>> make_pieces() {
  testing::RandomProfiles random(kSeed);
  std::vector<std::unique_ptr<Piece>> pieces;
  for (int i = 0; i < kPieces; ++i) {
    ProfileRequest request = random.next(testing::kPathClasses[i % 4]);
    const double slack = random.uniform(1.05, 1.8);
    const auto planned = testing::planned(request, i % 4 == 3 ? std::nullopt : std::optional(slack));
    if (!planned) continue;
    auto piece =
        std::unique_ptr<Piece>(new Piece{*planned, Replanner(planned->request, planned->plan),
                                         testing::RandomSituations(kSeed + static_cast<unsigned>(i))});
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// One situation in ten is blocked ahead, at a random distance: some too near to stop.
Situation next(Piece& piece, testing::RandomProfiles& random) {
  Situation situation = piece.situations.next(piece.planned);
  if (random.choice(10) == 0)
    situation.stop_at = situation.s + random.uniform(0.02, 0.5) * piece.replanner.length();
  return situation;
}

struct Figures {
  Sample ms{};  ///< of each call
  Sample
      again_ms{};  ///< the lesser of a call's times in two runs of the same calls: the machine interrupts one
  Sample ratio{}, use{}, late_s{};
  std::array<long, 4> status{};
  long calls{}, iterations{}, judged{}, late_unneeded{}, stopped_unneeded{};
};

void judge_call(const Piece& piece, const Situation& situation, const Replan& replan, Figures& figures) {
  if (std::isfinite(situation.stop_at) || replan.above_cap_until > 0) return;
  const ProfileRequest request = testing::asked(piece.planned, situation);
  const testing::Judgment best = testing::judge(request, situation.s);
  ++figures.judged;
  if (replan.status == ReplanStatus::stopping) {
    figures.stopped_unneeded += best.possible;
    return;
  }
  figures.use.values.push_back(testing::worst_use(request, *replan.profile));
  const double end_s = std::max(best.least_time_s, situation.time_left_s);
  if (std::isfinite(end_s)) {
    figures.late_s.values.push_back(replan.duration_s - end_s);
    figures.late_unneeded += replan.duration_s > end_s + kAllowed_s;
  }
  if (best.energy_J && replan.status != ReplanStatus::late)
    figures.ratio.values.push_back(testing::exact_energy_J(path_motion(request), *replan.profile) /
                                   *best.energy_J);
}

/// `judged_every` 0: none is judged.
Figures run_calls(long count, long judged_every) {
  std::vector<std::unique_ptr<Piece>> pieces = make_pieces();
  testing::RandomProfiles random(kSeed + 1);
  Figures figures;
  for (long call = 0; call < count; ++call) {
    Piece& piece = *pieces[static_cast<std::size_t>(call / kCallsAPiece) % pieces.size()];
    const Situation situation = next(piece, random);
    const double before_s = nlp::thread_cpu_s();
    const Replan& replan = piece.replanner.replan(situation);
    figures.ms.values.push_back(1e3 * (nlp::thread_cpu_s() - before_s));
    ++figures.status[static_cast<std::size_t>(replan.status)];
    figures.iterations += replan.iterations;
    ++figures.calls;
    if (judged_every > 0 && call % judged_every == 0) judge_call(piece, situation, replan, figures);
  }
  return figures;
}

std::string text_of(Figures& f, const std::string& provenance) {
  return "# The replanner, measured\n\n" + provenance +
         "\nThe machine ran other work at the same time; times are CPU times of the calling thread.\n\n"
         "Situations: " +
         std::to_string(kPieces) +
         " planned pieces (straight, Bezier, corners, tight corners; N = 200; deadline 1.05 to 1.8 times the "
         "least time, or free), rate off the plan by -20 to +5 %, payload 0 to 130 % in one call of three, "
         "5 % less to 10 % more time, a new speed limit ahead in one call of four, a blocked stretch in one "
         "of ten.\n\n| | measured | target |\n|---|---|---|\n" +
         format("| calls | %ld | 1,000,000 |\n", f.calls) +
         format("| CPU time of a call: median, p99, max | %.2f, %.2f, %.2f ms | -, 2, 5 ms |\n",
                f.ms.share(0.5), f.ms.share(0.99), f.ms.share(1)) +
         format("| the same, the lesser of two runs of the same calls | %.2f, %.2f, %.2f ms | -, 2, 5 ms |\n",
                f.again_ms.share(0.5), f.again_ms.share(0.99), f.again_ms.share(1)) +
         format("| iterations, mean | %.1f | |\n",
                static_cast<double>(f.iterations) / static_cast<double>(f.calls)) +
         format("| optimal, feasible, late, stopping | %ld, %ld, %ld, %ld | |\n", f.status[0], f.status[1],
                f.status[2], f.status[3]) +
         format("| judged against the optimum on 800 nodes, transcribed afresh | %ld | |\n", f.judged) +
         format("| energy / optimum (%zu): median, p99, max | %.5f, %.4f, %.4f | max 1.01 |\n",
                f.ratio.values.size(), f.ratio.share(0.5), f.ratio.share(0.99), f.ratio.share(1)) +
         format(
             "| later than the deadline, or than the least time if that is later (%zu): p99, max | %.4f, "
             "%.4f s | 0.05 s |\n",
             f.late_s.values.size(), f.late_s.share(0.99), f.late_s.share(1)) +
         format("| late by more than 50 ms where the optimum is not | %ld | 0 |\n", f.late_unneeded) +
         format("| stopping where a profile leads on | %ld | 0 |\n", f.stopped_unneeded) +
         format("| use of a limit, between nodes too (1 is the limit): p99, max | %.5f, %.4f | |\n",
                f.use.share(0.99), f.use.share(1));
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: %s FILE CALLS JUDGED_EVERY PROVENANCE\n", argv[0]);
    return 2;
  }
  joulepath::Figures figures = joulepath::run_calls(std::atol(argv[2]), std::atol(argv[3]));
  figures.again_ms = joulepath::run_calls(std::atol(argv[2]), 0).ms;
  std::ranges::transform(figures.ms.values, figures.again_ms.values, figures.again_ms.values.begin(),
                         [](double first, double second) { return std::min(first, second); });
  const std::string text = joulepath::text_of(figures, argv[4]);
  std::ofstream(argv[1]) << text;
  std::fputs(text.c_str(), stdout);
  return 0;
}
