#include "planner/ways/swing.hpp"

#include <algorithm>
#include <cmath>

#include "planner/ways/spline_search.hpp"
#include "planner/ways/swing_guesses.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kStarts = 12;    ///< number of guesses that are polished
constexpr std::size_t kSameSpans = 4;  ///< of them with the same number of spans
constexpr std::size_t kAgain = 4;      ///< number of curves that are polished again
constexpr double kNearBest = 0.02;     ///< their excess over the cheapest one at most
constexpr double kSame_m = 0.02;       ///< curves this close everywhere are one
constexpr int kFirstEvaluations = 20, kMoreEvaluations = 30;
constexpr double kMostBlocked = 0.3;  ///< share of a guess in the way of obstacles
constexpr double kPerBlocked = 2.0;   ///< increase of its value by that share
constexpr double kLook_m = 0.06;

struct JudgedGuess {
  SwingGuess guess{};
  double value{};
};

class Swing {
 public:
  Swing(const SwingRequest& request, const FootprintChecker& checker, LegDrafts& drafts)
      : request_(request), checker_(checker), drafts_(drafts) {}

  std::vector<SwingResult> run();

 private:
  std::vector<JudgedGuess> picked();
  double blocked(const Path& path) const;
  double value(const FreeSpline& spline);
  std::optional<SwingResult> polished(const SwingGuess& guess, int most_evaluations, double cost_to_beat);

  const SwingRequest& request_;
  const FootprintChecker& checker_;
  LegDrafts& drafts_;
};

/// Compares places at equal shares of the lengths.
bool same_curve(const Path& a, const Path& b) {
  for (int i = 1; i < 16; ++i) {
    const Curve &p = std::get<Curve>(a.pieces.front()), &q = std::get<Curve>(b.pieces.front());
    const Pose at = p.at(p.length_m() * i / 16).pose, other = q.at(q.length_m() * i / 16).pose;
    if (distance_m({at.x_m, at.y_m}, {other.x_m, other.y_m}) > kSame_m) return false;
  }
  return true;
}

bool cheaper(const SwingResult& a, const SwingResult& b) { return a.cost < b.cost; }

/// Share of a path that is not free.
double Swing::blocked(const Path& path) const {
  const Curve& curve = std::get<Curve>(path.pieces.front());
  const int looks = 1 + static_cast<int>(curve.length_m() / kLook_m);
  int in_the_way = 0;
  for (int i = 0; i <= looks; ++i)
    in_the_way +=
        checker_.slack_m(checker_.pose_on(curve, curve.length_m() * i / looks)) < kClearanceMargin_m;
  return in_the_way / (1.0 + looks);
}

/// The cost, larger where a part of the path is not free; infinite for a guess that is of no use.
double Swing::value(const FreeSpline& spline) {
  const std::optional<Path> path = free_spline_path(spline);
  if (!path) return kNoLimit;
  const double share = blocked(*path);
  if (share > kMostBlocked) return kNoLimit;
  drafts_.restart();
  return drafts_.cost_J(*path) * (1 + kPerBlocked * share);
}

/// The guesses to polish: the cheapest, at most kSameSpans with the same number of spans.
std::vector<JudgedGuess> Swing::picked() {
  std::vector<JudgedGuess> judged;
  for (SwingGuess& guess : swing_guesses(request_)) {
    const double cost = value(guess.spline);
    if (std::isfinite(cost)) judged.push_back({std::move(guess), cost});
  }
  std::stable_sort(judged.begin(), judged.end(),
                   [](const JudgedGuess& a, const JudgedGuess& b) { return a.value < b.value; });
  std::vector<JudgedGuess> picked;
  for (const JudgedGuess& one : judged) {
    const auto alike = std::count_if(picked.begin(), picked.end(), [&](const JudgedGuess& other) {
      return other.guess.spline.points_m.size() == one.guess.spline.points_m.size();
    });
    if (picked.size() < kStarts && static_cast<std::size_t>(alike) < kSameSpans) picked.push_back(one);
  }
  return picked;
}

/// Optimizes both handles, a free goal heading and the moving knots.
std::optional<SwingResult> Swing::polished(const SwingGuess& guess, int most_evaluations,
                                           double cost_to_beat) {
  using Kind = SplineMember::Kind;
  SplineSearch search{.checker = &checker_,
                      .first = {guess.spline},
                      .cost_to_beat = cost_to_beat,
                      .most_evaluations = most_evaluations};
  search.variables = {{{{Kind::start_handle}}}, {{{Kind::goal_handle}}}};
  if (!request_.goal_heading_rad) search.variables.push_back({{{Kind::goal_heading}}});
  for (const std::size_t knot : guess.moving) search.variables.push_back({{{Kind::knot, 0, knot}}});
  drafts_.restart();
  search.cost = [&](const std::vector<Path>& paths) { return drafts_.cost_J(paths.front()); };
  search.slopes = [&](const std::vector<FreeSpline>& splines) {
    return std::vector<SplineSlopes>{drafts_.slopes(splines.front())};
  };
  std::optional<SplineSearchResult> found = minimize(search);
  if (!found) return std::nullopt;
  drafts_.restart();
  const double cost = drafts_.cost_J(found->paths.front());
  if (!std::isfinite(cost)) return std::nullopt;
  return SwingResult{std::move(found->splines.front()), std::move(found->paths.front()), cost};
}

std::vector<SwingResult> Swing::run() {
  std::vector<SwingResult> found;
  double least = kNoLimit;
  for (const JudgedGuess& judged : picked())
    if (auto result = polished(judged.guess, kFirstEvaluations, least)) {
      least = std::min(least, result->cost);
      found.push_back(std::move(*result));
    }
  std::stable_sort(found.begin(), found.end(), cheaper);
  for (std::size_t i = 0; i < std::min(kAgain, found.size()); ++i) {
    if (found[i].cost - least > kNearBest * std::abs(least)) break;
    const auto same = [&](const SwingResult& other) { return same_curve(other.path, found[i].path); };
    const auto here = found.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(found.begin(), here, same)) continue;
    SwingGuess again{.spline = found[i].spline};
    for (std::size_t knot = 1; knot + 1 < again.spline.points_m.size(); ++knot) again.moving.push_back(knot);
    std::optional<SwingResult> better = polished(again, kMoreEvaluations, least);
    if (better) least = std::min(least, better->cost);
    if (better && better->cost < found[i].cost) found[i] = std::move(*better);
  }
  std::stable_sort(found.begin(), found.end(), cheaper);
  return found;
}

}  // namespace

std::vector<SwingResult> best_swings(const SwingRequest& request, const FootprintChecker& checker,
                                     LegDrafts& drafts) {
  return Swing(request, checker, drafts).run();
}

}  // namespace joulepath
