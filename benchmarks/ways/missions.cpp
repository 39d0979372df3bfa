// How much of the saving that a brute-force search finds on whole missions the planner reaches.
// usage: bench_ways_missions COUNT SEED NOTE
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "benchmarks/missions/draw.hpp"
#include "benchmarks/ways/brute_force.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath::ways {
namespace {

using bench::DrawnMission;
using bench::Floor;

constexpr WaySteps kPlain{.corners = false, .routes = false, .stops = false, .refinement = false};
constexpr SearchSize kSize{.samples = 100, .descents = 2, .evaluations = 400, .refinements = 300};
constexpr double kSame = 1e-4;       ///< relative, of two energies
constexpr double kKnotsEvery_m = 3;  ///< of a spline along a given path
constexpr std::size_t kMostKnots = 12;

std::optional<Plan> planned(const Floor& floor, const MissionRequest& mission, const WaySteps& steps = {}) {
  const PlanOptions options{.solver = SolverChoice::fast, .steps = steps, .baselines = false};
  Plan plan = plan_mission(mission, floor.world, options, &floor.space);
  if (plan.status != SolveStatus::optimal && plan.status != SolveStatus::feasible) return std::nullopt;
  return plan;
}

Path path_of(const LegPlan& leg) {
  Path path;
  for (const StretchPlan& stretch : leg.stretches) path.pieces.push_back(stretch.request.piece);
  return path;
}

/// A spline near a path, from its first to its last pose: it goes through the joints of a single curve, or
/// through places at equal distances.
FreeSpline spline_along(const Path& path) {
  FreeSpline spline{.points_m = {{path.start().x_m, path.start().y_m}},
                    .start_heading_rad = path.start().heading_rad,
                    .goal_heading_rad = path.end().heading_rad};
  const auto* curve = path.pieces.size() == 1 ? std::get_if<Curve>(&path.pieces.front()) : nullptr;
  const double length_m = path.distance_m();
  spline.start_handle_m = spline.goal_handle_m = 0.1;
  std::vector<double> places_m;
  if (curve && curve->segments().size() <= kMostKnots) {
    const std::vector<double>& ends_m = curve->breakpoints_m();
    places_m.assign(ends_m.begin() + 1, ends_m.end() - 1);
    const auto* first = std::get_if<BezierSegment>(&curve->segments().front());
    const auto* last = std::get_if<BezierSegment>(&curve->segments().back());
    if (first && !first->rational())
      spline.start_handle_m = distance_m(first->points_m()[0], first->points_m()[1]);
    if (last && !last->rational())
      spline.goal_handle_m = distance_m(last->points_m()[2], last->points_m()[3]);
  } else {
    const auto knots = std::min(kMostKnots, static_cast<std::size_t>(length_m / kKnotsEvery_m));
    for (std::size_t k = 1; k <= knots; ++k)
      places_m.push_back(length_m * static_cast<double>(k) / static_cast<double>(knots + 1));
  }
  double before_m = 0;
  auto next = places_m.begin();
  for (const PathPiece& piece : path.pieces) {
    if (is_turn(piece)) continue;
    for (; next != places_m.end() && *next <= before_m + piece_length(piece); ++next) {
      const Pose pose = piece_point(piece, *next - before_m).pose;
      spline.points_m.push_back({pose.x_m, pose.y_m});
    }
    before_m += piece_length(piece);
  }
  spline.points_m.push_back({path.end().x_m, path.end().y_m});
  return spline;
}

struct Result {
  std::string floor{};
  double distance_m{};
  EnergyByCause plain{}, plan{}, reference{};
  int legs_better{};  ///< for which the search found a cheaper path

  double share() const {
    return (plain.total_J() - plan.total_J()) / (plain.total_J() - reference.total_J());
  }
  double excess_percent() const { return 100 * (plan.total_J() / reference.total_J() - 1); }
  double motion_percent() const { return 100 * (plan.motion_J() / reference.motion_J() - 1); }
};

/// The plan's legs, each along the best path known between the same two poses.
std::optional<Result> judged(const Floor& floor, const MissionRequest& mission, std::mt19937& random) {
  const std::optional<Plan> plain = planned(floor, mission, kPlain), plan = planned(floor, mission);
  if (!plain || !plan) return std::nullopt;
  Result result{.floor = floor.name,
                .distance_m = plan->distance_m,
                .plain = plain->energy,
                .plan = plan->energy,
                .reference = plan->energy};
  MissionRequest best = mission;
  for (std::size_t k = 0; k < plan->legs.size(); ++k) {
    const LegPlan& leg = plan->legs[k];
    const Path path = path_of(leg);
    const Pose goal = path.end();
    const Problem problem{.floor = floor.name,
                          .start = path.start(),
                          .goal_m = {goal.x_m, goal.y_m},
                          .goal_heading_rad = goal.heading_rad,
                          .payload_kg = mission.legs[k].payload.from_kg};
    const BestSpline found = brute_force(floor, problem, random, kSize, {spline_along(path)});
    const bool better = found.energy_J < driven_J(floor, problem, path) * (1 - kSame);
    result.legs_better += better;
    best.legs[k].path = PathRequest{.ready = better ? *free_spline_path(found.spline) : path};
    if (k == 0) best.start.pose = path.start(), best.start.heading_given = true;
  }
  const std::optional<Plan> reference = planned(floor, best);
  if (reference && reference->energy.total_J() < result.reference.total_J())
    result.reference = reference->energy;
  return result;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

template <class Figure>
std::vector<double> all_of(const std::vector<Result>& results, Figure figure) {
  std::vector<double> values;
  for (const Result& result : results) values.push_back(figure(result));
  return values;
}

void print(const std::vector<Result>& results, int refused, const char* note) {
  std::printf("# Missions against a brute-force search\n\n%s\n\n", note);
  std::printf(
      "%zu missions as `./dev bench missions` draws them: three picks of 1 to 4 kg and a drop where the "
      "robot "
      "began, stops in\nthe order drawn, 10 W of standby counted, time free; %d draws were not planned. "
      "*Stop, "
      "turn, go* is the plan without ways\n(`--without corners,routes,stops,refinement`). The reference "
      "keeps "
      "the poses at the stops that the plan has chosen. Every\nleg takes the best path known between its two "
      "poses: the plan's, or one of a search (CMA-ES and Nelder-Mead over C2 cubic\nsplines, %d random "
      "splines and %d descents of %d and %d evaluations per number of spans from one to four, two descents "
      "more\nfrom the plan's own path). On long legs around racks random splines find little: there the "
      "reference is a local one.\nOther headings at the stops are not searched.\n\n",
      results.size(), refused, kSize.samples, kSize.descents, kSize.evaluations, kSize.refinements);
  std::puts(
      "| floor | way | stop, turn, go | plan | reference | share of the saving | excess | excess, motion "
      "alone | "
      "legs with a cheaper path |\n|---|---|---|---|---|---|---|---|---|");
  for (const Result& r : results)
    std::printf("| %s | %.0f m | %.1f J | %.1f J | %.1f J | %.1f %% | %.2f %% | %.2f %% | %d |\n",
                r.floor.c_str(), r.distance_m, r.plain.total_J(), r.plan.total_J(), r.reference.total_J(),
                100 * r.share(), r.excess_percent(), r.motion_percent(), r.legs_better);
  const std::vector<double> share = all_of(results, [](const Result&r) { return 100 * r.share(); }),
                            excess = all_of(results, [](const Result&r) { return r.excess_percent(); }),
                            motion = all_of(results, [](const Result&r) { return r.motion_percent(); });
  const auto dearer = std::count_if(results.begin(), results.end(), [](const Result& r) {
    return r.plan.total_J() > r.plain.total_J() * (1 + kSame);
  });
  const auto sum_of = [&](auto part) {
    return std::accumulate(results.begin(), results.end(), 0.0,
                           [&](double sum, const Result& r) { return sum + part(r); });
  };
  const double plain_J = sum_of([](const Result&r) { return r.plain.total_J(); }),
               plan_J = sum_of([](const Result&r) { return r.plan.total_J(); }),
               reference_J = sum_of([](const Result&r) { return r.reference.total_J(); });
  std::printf(
      "\n- Share of the saving (stop, turn, go less the reference) that the plans reach: median %.1f %%, "
      "least "
      "%.1f %%, of all\n  missions together %.1f %%.\n- Plans dearer than stop, turn, go: %td.\n- Excess "
      "over the "
      "reference: median %.2f %%, most %.2f %%; of the motion's energy alone: median %.2f %%, most %.2f "
      "%%.\n",
      median(share), *std::min_element(share.begin(), share.end()),
      100 * (plain_J - plan_J) / (plain_J - reference_J), dearer, median(excess),
      *std::max_element(excess.begin(), excess.end()), median(motion),
      *std::max_element(motion.begin(), motion.end()));
}

}  // namespace
}  // namespace joulepath::ways

int main(int argc, char** argv) {
  using namespace joulepath;
  if (argc < 4) return std::fputs("usage: bench_ways_missions COUNT SEED NOTE\n", stderr), 2;
  const std::size_t count = std::stoul(argv[1]);
  std::mt19937 random(static_cast<unsigned>(std::stoul(argv[2])));
  const Robot robot = read_robot(JOULEPATH_SOURCE_DIR "/scenarios/robots/nomad_super_scout.yaml");
  const std::vector<bench::Floor> floors = bench::floors(robot);
  std::vector<ways::Result> results;
  std::size_t draws = 0;
  for (; results.size() < count && draws < 10 * count; ++draws) {
    const bench::Floor& floor = floors[results.size() % floors.size()];
    const bench::DrawnMission drawn = bench::random_mission(floor, random);
    std::mt19937 searching(static_cast<unsigned>(draws));
    if (auto one = ways::judged(floor, drawn.with(drawn.legs_in({0, 1, 2, 3})), searching))
      results.push_back(std::move(*one));
    std::fprintf(stderr, "\r%zu of %zu missions", results.size(), count);
  }
  std::fprintf(stderr, "\n");
  if (results.empty()) return 1;
  ways::print(results, static_cast<int>(draws - results.size()), argv[3]);
  return 0;
}
