#include "planner/ways/leg_drafts.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath {
namespace {

constexpr double kStep_rad = 1e-4;  ///< of differences: costs of turns are a table between angles

}  // namespace

LegDrafts::LegDrafts(const ChoiceContext& context, std::size_t leg_index,
                     std::function<double(double)> turning_J)
    : context_(context), leg_index_(leg_index), turning_J_(std::move(turning_J)) {
  restart();
}

double LegDrafts::cost_J(const Path& path) {
  path_ = path;
  double sum_J = turning_J_ ? turning_J_(path.end().heading_rad) : 0.0;
  if (!std::isfinite(sum_J)) return sum_J;
  std::vector<ProfileRequest> stretches =
      stretches_of(path, context_.mission.legs[leg_index_], leg_index_, context_.mission, context_.world,
                   context_.plant, context_.options);
  ProfileRequest& request = stretches.front();
  request.nodes = std::min(request.nodes, kScoringNodes);
  request.draft = true;
  const double price_W = context_.finite_price_W();
  if (price_W != 0) request.time = {.mode = TimeMode::time_price, .price_W = price_W};
  const std::optional<DraftSeries::Cost> drive = series_->solve(request);
  return drive ? sum_J + drive->cost_J : kNoLimit;
}

SplineSlopes LegDrafts::slopes(const FreeSpline& spline) const {
  SplineSlopes slopes = spline_slopes(spline, std::get<Curve>(path_.pieces.front()), series_->slopes());
  if (turning_J_) {
    const double arrives_rad = path_.end().heading_rad;
    slopes.by_goal_heading_rad +=
        (turning_J_(arrives_rad + kStep_rad) - turning_J_(arrives_rad - kStep_rad)) / (2 * kStep_rad);
  }
  return slopes;
}

}  // namespace joulepath
