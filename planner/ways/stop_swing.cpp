#include "planner/ways/stop_swing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/ways/spline_search.hpp"

namespace joulepath {
namespace {

constexpr int kHeadings = 8;          ///< first guesses of the heading at the stop
constexpr int kEvaluations = 25;      ///< of one optimization
constexpr std::size_t kPolished = 2;  ///< of them, beside the one in which the curves meet

class StopSwing {
 public:
  StopSwing(const StopRequest& request, const FootprintChecker& checker) : request_(request) {
    using Kind = SplineMember::Kind;
    search_.checker = &checker;
    search_.first = {request.before, request.after};
    search_.variables = {{{{Kind::goal_heading, 0}, {Kind::start_heading, 1}}}};
    for (std::size_t k = 0; k < 2; ++k) {
      search_.variables.push_back({{{Kind::start_handle, k}}});
      search_.variables.push_back({{{Kind::goal_handle, k}}});
      for (std::size_t knot = 1; knot + 1 < search_.first[k].points_m.size(); ++knot)
        search_.variables.push_back({{{Kind::knot, k, knot}}});
    }
    search_.cost = [this](const auto& paths) {
      return request_.drafts_before.cost_J(paths[0]) + request_.drafts_after.cost_J(paths[1]);
    };
    search_.slopes = [this](const auto& splines) {
      return std::vector<SplineSlopes>{request_.drafts_before.slopes(splines[0]),
                                       request_.drafts_after.slopes(splines[1])};
    };
    search_.most_evaluations = kEvaluations;
  }

  std::optional<StopResult> run() {
    const std::vector<std::vector<FreeSpline>> others = around();
    polish(search_.first);
    for (const std::vector<FreeSpline>& splines : others) polish(splines);
    if (!best_) return std::nullopt;
    polish(std::vector<FreeSpline>(best_->splines));
    return StopResult{.before = {best_->splines[0], best_->paths[0], 0},
                      .after = {best_->splines[1], best_->paths[1], 0},
                      .cost = best_->cost};
  }

 private:
  void restart() {
    request_.drafts_before.restart();
    request_.drafts_after.restart();
  }
  /// The same curves with other headings at the stop, the cheapest of them.
  std::vector<std::vector<FreeSpline>> around() {
    std::vector<std::pair<double, std::vector<FreeSpline>>> judged;
    for (int i = 1; i < kHeadings; ++i) {
      std::vector<FreeSpline> splines = search_.first;
      splines[0].goal_heading_rad += 2 * std::numbers::pi * i / kHeadings;
      splines[1].start_heading_rad = splines[0].goal_heading_rad;
      std::vector<Path> paths;
      for (const FreeSpline& spline : splines)
        if (std::optional<Path> path = free_spline_path(spline)) paths.push_back(std::move(*path));
      if (paths.size() < splines.size()) continue;
      restart();
      const double cost = search_.cost(paths);
      if (std::isfinite(cost)) judged.emplace_back(cost, std::move(splines));
    }
    std::stable_sort(judged.begin(), judged.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<std::vector<FreeSpline>> cheapest;
    for (std::size_t i = 0; i < std::min(kPolished, judged.size()); ++i)
      cheapest.push_back(std::move(judged[i].second));
    return cheapest;
  }
  void polish(const std::vector<FreeSpline>& first) {
    search_.first = first;
    restart();
    if (best_) search_.cost_to_beat = best_->cost;
    std::optional<SplineSearchResult> found = minimize(search_);
    if (!found) return;
    restart();
    found->cost = search_.cost(found->paths);
    if (std::isfinite(found->cost) && (!best_ || found->cost < best_->cost)) best_ = std::move(found);
  }

  const StopRequest& request_;
  SplineSearch search_{};
  std::optional<SplineSearchResult> best_{};
};

}  // namespace

std::optional<StopResult> best_stop(const StopRequest& request, const FootprintChecker& checker) {
  return StopSwing(request, checker).run();
}

}  // namespace joulepath
