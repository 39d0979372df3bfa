#include "planner/joint/joint_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/joint/finer_pieces.hpp"
#include "planner/joint/joint_newton.hpp"
#include "planner/joint/path_geometry.hpp"
#include "planner/joint/start_fit.hpp"

namespace joulepath::joint {
namespace {

constexpr std::size_t kCoarse = 5, kFine = 7;  ///< segments per piece
constexpr std::size_t kFewest = 2;             ///< of a part of a piece
constexpr std::size_t kMostPieces = 80;        ///< for which pieces that bend are cut
constexpr double kNear_m = 0.1;                ///< of obstacles
constexpr double kGiveUp = 1.02, kHopeless = 1.025, kSame = 3e-4;
/// The candidates that are refined: how many, and how near to the best.
struct Choice {
  std::size_t most{};
  double near{};
};
constexpr Choice kRanked{2, 1.005}, kUnranked{5, 1.05};  ///< unranked: the program lacks a limit
constexpr double kFineTolerance = 6e-4;
constexpr double kWarmGap = 0.05, kMarginGap = 0.01;   ///< NewtonOptions::gap from a solution
constexpr int kMostSteps = 50, kMostStepsAgain = 100;  ///< of a start; where none converged
constexpr double kPause = 0.03;                        ///< NewtonOptions::pause of all starts
constexpr int kMarginRounds = 3;
constexpr double kMarginStep_m = 1e-3;
constexpr double kOnBound_rad = 0.05;

struct Candidate {
  Start start{};
  JointSolution solution{};
};

bool near_obstacles(const Program& program, const Eigen::VectorXd& parameters) {
  if (!program.checker) return false;
  const std::vector<Path> paths = paths_of(program, parameters);
  return std::any_of(paths.begin(), paths.end(), [&](const Path& path) {
    return program.checker->with_clearance(program.checker->clearance_m() + kNear_m)
        .first_collision(path)
        .has_value();
  });
}

/// The program leaves the jerk limit out.
bool knows_all_limits(const Program& program) { return std::isinf(program.laws.front().limits.jerk_m_s3); }

/// Whether a knot lies on the bound of the direction: a wider one may be cheaper.
bool is_bound(const Program& program, const Eigen::VectorXd& p) {
  return std::any_of(program.pieces.begin(), program.pieces.end(), [&](const Piece& piece) {
    return !piece.turns && piece.bend_rad(p) > program.most_direction_rad - kOnBound_rad;
  });
}

/// The grid of the finer pieces.
void lay_grid(FinerPieces& finer) {
  std::size_t next = 0;
  for (const std::size_t parts : finer.parts)
    for (std::size_t part = 0; part < parts; ++part, ++next)
      finer.start.program.pieces[next].segments = std::max(kFewest, (kFine + parts - 1) / parts);
}

/// The solution on a finer grid from a coarse one, with finer pieces where the method converges on them; the
/// cheapest that is nearly feasible where it converges on neither.
Candidate refined(const Candidate& coarse) {
  const bool is_near = near_obstacles(coarse.start.program, coarse.solution.parameters);
  // With more pieces, or sharper ones, paths would follow a limit that the program lacks.
  const bool knows_limits = knows_all_limits(coarse.start.program);
  const bool widens = knows_limits && is_bound(coarse.start.program, coarse.solution.parameters);
  Candidate best = coarse;
  for (std::size_t most_pieces = knows_limits ? kMostPieces : 0;; most_pieces = 0) {
    FinerPieces finer = cut(coarse.start.program, coarse.solution.parameters, most_pieces);
    lay_grid(finer);
    if (is_near) finer.start.program.margin_m += kMarginStep_m;
    if (widens) finer.start.program.most_direction_rad = kWiderDirection_rad;
    const bool whole = finer.start.program.pieces.size() == coarse.start.program.pieces.size();
    const Eigen::VectorXd squares = on_grid(coarse.start.program, coarse.solution.squares, finer);
    Candidate fine{.start = std::move(finer.start)};
    fine.solution = JointNewton(fine.start, kWarmGap, squares).run({.tolerance = kFineTolerance});
    if (fine.solution.converged) return fine;
    if (fine.solution.feasible && fine.solution.cost_J < best.solution.cost_J) best = std::move(fine);
    if (whole) return best;
  }
}

/// Largest missing clearance along paths; negative: a path cannot be driven as it is.
double short_by_m(const std::vector<Path>& paths, const FootprintChecker* checker) {
  double worst_m = 0;
  if (checker)
    for (const Path& path : paths)
      for (const PathPiece& piece : path.pieces) {
        if (!checker->first_collision(piece)) continue;
        const double length = piece_length(piece);
        const int looks = 1 + static_cast<int>(length / 0.005);
        for (int i = 0; i <= looks; ++i)
          worst_m = std::max(worst_m, -checker->near_slack_m(piece_point(piece, length * i / looks).pose));
        worst_m = std::max(worst_m, 1e-6);
      }
  return worst_m;
}

std::vector<Sketch> sketches_of(const Program& program, const Eigen::VectorXd& p) {
  std::vector<Sketch> legs(program.targets.size());
  for (std::size_t j = 0; j < program.pieces.size(); ++j) {
    const Piece& piece = program.pieces[j];
    const bool inside = j + 1 < program.pieces.size() && program.pieces[j + 1].leg == piece.leg;
    legs[piece.leg].parts.push_back({.from_rad = p[piece.from],
                                     .to_rad = p[piece.to],
                                     .length_m = p[program.length_of(j)],
                                     .sign = piece.sign,
                                     .rests_after = piece.rests_after && inside});
  }
  return legs;
}

/// Paths that meet their goals to rounding and are free. The rows look every few centimetres: a corner that a
/// path cuts between the looks is mended by a larger margin.
std::optional<JointPaths> finished(Candidate candidate) {
  for (int round = 0; round <= kMarginRounds; ++round) {
    Eigen::VectorXd exact = candidate.solution.parameters;
    reach_targets(candidate.start.program, exact, 10);
    PathGeometry geometry(candidate.start.program);
    geometry.place(exact);
    const bool reached =
        geometry.errors().norm() < 1e-10 && (exact - candidate.solution.parameters).norm() < 0.05;
    if (!reached) return std::nullopt;
    JointPaths paths{paths_of(candidate.start.program, exact), candidate.solution.cost_J,
                     sketches_of(candidate.start.program, exact)};
    const double short_m = short_by_m(paths.legs, candidate.start.program.checker);
    if (short_m == 0) return paths;
    candidate.start.program.margin_m += short_m + kMarginStep_m;
    candidate.start.parameters = candidate.solution.parameters;
    const JointSolution again = JointNewton(candidate.start, kMarginGap, candidate.solution.squares)
                                    .run({.tolerance = kFineTolerance});
    if (!again.parameters.allFinite()) return std::nullopt;
    candidate.solution = again;
  }
  return std::nullopt;
}

CurveSegment segment_of(const Program& program, const Piece& piece, const Pose& start,
                        const Eigen::VectorXd& p, double length_m) {
  const auto phi = [&](Eigen::Index knot) { return piece.sign > 0 ? p[knot] : std::numbers::pi - p[knot]; };
  Pose along = start;
  if (piece.sign < 0) along.heading_rad -= std::numbers::pi;
  return DirectionSegment(along, {phi(piece.from), phi(piece.to), length_m, program.half_track_m()});
}

/// All starts on the coarse grid. Each goes a part of its way; then the one that promises most goes on first,
/// and the others only as long as they may become the best.
class Exploration {
 public:
  Exploration(const JointQuery& query, const std::vector<std::vector<Sketch>>& starts) {
    const double half_track_m = query.laws.front().half_track_m;
    for (const std::vector<Sketch>& sketches : starts) {
      Start start = assemble(sketches, query.goals, query.start, half_track_m, kCoarse);
      start.program.laws = query.laws;
      start.program.laws.insert(start.program.laws.end(), query.reverse_laws.begin(),
                                query.reverse_laws.end());
      start.program.checker = query.checker;
      JointNewton newton(start);
      JointSolution rough = newton.run({.most_steps = kMostSteps, .pause = kPause});
      runs_.push_back({std::move(start), std::move(newton), std::move(rough)});
    }
    for (Run& run : runs_) order_.push_back(&run);
  }

  /// The solutions that may be the best after so many steps in all, in the order of their cost.
  std::vector<Candidate> found(int most_steps) {
    std::vector<Candidate> found;
    double best_J = kNoLimit, least_J = kNoLimit;
    std::stable_sort(order_.begin(), order_.end(), [](const Run* a, const Run* b) {
      return std::isfinite(a->solution.cost_J) &&
             !(b->solution.cost_J <= a->solution.cost_J);  // one that is no number stands last
    });
    for (Run* run : order_) {
      if (run->solution.cost_J > kHopeless * least_J) break;
      run->solution = run->newton.run({.most_steps = most_steps, .give_up_J = kGiveUp * best_J});
      const JointSolution& solution = run->solution;
      if (!solution.feasible) continue;
      if (solution.converged) best_J = std::min(best_J, solution.cost_J);
      least_J = std::min(least_J, solution.cost_J);
      found.push_back({run->start, solution});
    }
    std::stable_sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
      return a.solution.cost_J < b.solution.cost_J;
    });
    return found;
  }

 private:
  struct Run {
    Start start{};
    JointNewton newton;
    JointSolution solution{};
  };
  std::vector<Run> runs_{};
  std::vector<Run*> order_{};
};

/// The best candidates on the fine grid that reach their goals and are free.
std::vector<JointPaths> finished(const std::vector<Candidate>& found) {
  std::vector<JointPaths> best;
  double last_J = 0;
  for (const Candidate& candidate : found) {
    const double cost_J = candidate.solution.cost_J;
    const Choice& choice = knows_all_limits(candidate.start.program) ? kRanked : kUnranked;
    if (best.size() == choice.most || (!best.empty() && cost_J > choice.near * best.front().cost_J)) break;
    if (std::abs(cost_J - last_J) < kSame * cost_J) continue;
    last_J = cost_J;
    if (auto paths = finished(refined(candidate))) best.push_back(std::move(*paths));
  }
  std::stable_sort(best.begin(), best.end(),
                   [](const JointPaths& a, const JointPaths& b) { return a.cost_J < b.cost_J; });
  return best;
}

}  // namespace

std::vector<Path> paths_of(const Program& program, const Eigen::VectorXd& p) {
  std::vector<Path> paths(1);
  std::vector<CurveSegment> segments;
  Pose here = program.frame;
  for (std::size_t j = 0; j < program.pieces.size(); ++j) {
    const Piece& piece = program.pieces[j];
    const bool last = j + 1 == program.pieces.size();
    if (piece.turns) {
      const double angle_rad = std::copysign(p[program.length_of(j)] / program.half_track_m(), p[piece.from]);
      paths.back().pieces.push_back(TurnInPlace{here, angle_rad});
      here.heading_rad += angle_rad;
    } else {
      segments.push_back(segment_of(program, piece, here, p, p[program.length_of(j)]));
      const auto& placed = std::get<DirectionSegment>(segments.back());
      here = placed.at(placed.length_m()).pose;
      if (piece.sign < 0) here.heading_rad += std::numbers::pi;
      if (!last && !piece.rests_after) continue;
      paths.back().pieces.push_back(
          Curve(std::move(segments), piece.sign > 0 ? Direction::forward : Direction::reverse));
      segments.clear();
    }
    if (!last && program.pieces[j + 1].leg != piece.leg) paths.emplace_back();
  }
  return paths;
}

std::vector<JointPaths> best_joint_paths(const JointQuery& query,
                                         const std::vector<std::vector<Sketch>>& starts) {
  Exploration exploration(query, starts);
  std::vector<Candidate> found = exploration.found(kMostSteps);
  if (std::none_of(found.begin(), found.end(), [](const Candidate& c) { return c.solution.converged; }))
    found = exploration.found(kMostStepsAgain);
  return finished(found);
}

std::optional<JointPaths> best_coarse_paths(const JointQuery& query,
                                            const std::vector<std::vector<Sketch>>& starts) {
  const std::vector<Candidate> found = Exploration(query, starts).found(kMostSteps);
  if (found.empty()) return std::nullopt;
  const auto& [start, solution] = found.front();
  return JointPaths{paths_of(start.program, solution.parameters), solution.cost_J,
                    sketches_of(start.program, solution.parameters)};
}

}  // namespace joulepath::joint
