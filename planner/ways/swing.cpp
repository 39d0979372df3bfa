#include "planner/ways/swing.hpp"

#include <algorithm>
#include <cmath>

#include "planner/ways/spline_search.hpp"
#include "planner/ways/swing_guesses.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kPolishedKnots = 4;  ///< greatest number of moving knots
constexpr std::size_t kSameSpans = 3;      ///< polished guesses with the same number of spans

struct JudgedGuess {
  SwingGuess guess{};
  double value{};
};

class Swing {
 public:
  Swing(const SwingRequest& request, const FootprintChecker& checker, const PathCost& cost,
        const SwingOptions& options)
      : request_(request), checker_(checker), cost_(cost), options_(options) {}

  std::optional<SwingResult> run();

 private:
  std::vector<JudgedGuess> picked();
  void polish(JudgedGuess& judged, double first_step_m);
  double value(const FreeSpline& spline);

  const SwingRequest& request_;
  const FootprintChecker& checker_;
  const PathCost& cost_;
  const SwingOptions& options_;
  std::optional<SwingResult> best_{};
  int evaluations_{};
};

bool cheaper(const JudgedGuess& a, const JudgedGuess& b) { return a.value < b.value; }

/// The cost, or a value above every cost where the spline cannot be driven.
double Swing::value(const FreeSpline& spline) {
  ++evaluations_;
  std::optional<Path> path = free_spline_path(spline);
  if (!path) return kNoCurve;
  if (const double in_the_way = blocked(checker_, *path)) return in_the_way;
  const double cost = cost_(*path);
  if (!std::isfinite(cost)) return kNotDrivable;
  if ((!best_ || cost < best_->cost) && !checker_.first_collision(*path))
    best_ = {.spline = spline, .path = std::move(*path), .cost = cost};
  return cost;
}

/// The guesses to polish: the cheapest, at most kSameSpans with the same number of spans.
std::vector<JudgedGuess> Swing::picked() {
  std::vector<JudgedGuess> judged;
  for (SwingGuess& guess : swing_guesses(request_)) {
    const double cost = value(guess.spline);
    judged.push_back({std::move(guess), cost});
  }
  std::stable_sort(judged.begin(), judged.end(), cheaper);
  std::vector<JudgedGuess> picked;
  for (const JudgedGuess& one : judged) {
    const auto alike = std::count_if(picked.begin(), picked.end(), [&](const JudgedGuess& other) {
      return other.guess.spline.points_m.size() == one.guess.spline.points_m.size();
    });
    if (picked.size() < options_.starts && static_cast<std::size_t>(alike) < kSameSpans)
      picked.push_back(one);
  }
  return picked;
}

/// Optimizes both handles, a free goal heading and the moving knots.
void Swing::polish(JudgedGuess& judged, double first_step_m) {
  const bool free_heading = !request_.goal_heading_rad;
  std::vector<std::size_t>& moving = judged.guess.moving;
  if (moving.size() > kPolishedKnots) moving.resize(kPolishedKnots);
  const FreeSpline first = judged.guess.spline;
  const auto spline_at = [&](const std::vector<double>& x) {
    FreeSpline spline = first;
    std::size_t i = 0;
    spline.start_handle_m = x[i++];
    spline.goal_handle_m = x[i++];
    if (free_heading) spline.goal_heading_rad = x[i++];
    for (const std::size_t knot : moving) {
      spline.points_m[knot] = {x[i], x[i + 1]};
      i += 2;
    }
    return spline;
  };
  SplineVariables variables;
  for (const double handle_m : {first.start_handle_m, first.goal_handle_m})
    variables.add_handle(handle_m, std::min(first_step_m, 0.5 * handle_m));
  if (free_heading) variables.add_heading(first.goal_heading_rad);
  for (const std::size_t knot : moving) variables.add_knot(first.points_m[knot], first_step_m);
  const double found = minimize(variables, options_.effort,
                                [&](const std::vector<double>& at) { return value(spline_at(at)); });
  if (found >= judged.value) return;
  judged.value = found;
  judged.guess.spline = spline_at(variables.value);
}

std::optional<SwingResult> Swing::run() {
  std::vector<JudgedGuess> polished = picked();
  for (JudgedGuess& judged : polished) polish(judged, kFirstStep_m);
  std::stable_sort(polished.begin(), polished.end(), cheaper);
  if (!polished.empty()) polish(polished.front(), 0.3 * kFirstStep_m);
  if (best_) best_->evaluations = evaluations_;
  return std::move(best_);
}

}  // namespace

std::optional<SwingResult> best_swing(const SwingRequest& request, const FootprintChecker& checker,
                                      const PathCost& cost, const SwingOptions& options) {
  return Swing(request, checker, cost, options).run();
}

}  // namespace joulepath
