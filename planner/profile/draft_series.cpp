#include "planner/profile/draft_series.hpp"

#include <algorithm>

#include "planner/nlp/fast/narrowing_kinks.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/nlp/transcription/lagrangian_slopes.hpp"
#include "planner/profile/first_guess.hpp"
#include "planner/profile/request_check.hpp"

namespace joulepath {
namespace {

constexpr double kWarmGap = 1e-2, kWarmRoom = 1e-3;
constexpr int kWarmIterations = 25;
constexpr double kSlower = 1.5;  ///< first guess of the duration, of the least one

}  // namespace

/// Places of the nodes on this curve, anew where the number of mandatory nodes has changed.
std::vector<double> DraftSeries::grid(const PathMotion& motion, const ProfileRequest& request) {
  mandatory_ = nlp::mandatory_nodes(motion, request);
  const std::vector<double>& mandatory = mandatory_;
  if (mandatory.size() != parts_ + 1) {
    const std::vector<double> s = nlp::make_grid(motion, request, request.nodes);
    parts_ = mandatory.size() - 1;
    places_.clear();
    solution_.converged = false;
    for (std::size_t part = 0, k = 0; k < s.size(); ++k) {
      while (part + 1 < parts_ && s[k] >= mandatory[part + 1]) ++part;
      places_.push_back({part, (s[k] - mandatory[part]) / (mandatory[part + 1] - mandatory[part])});
    }
    return s;
  }
  std::vector<double> s;
  for (const Place& place : places_) {
    const double from = mandatory[place.part], to = mandatory[place.part + 1];
    s.push_back(place.share == 0 ? from : place.share == 1 ? to : from + place.share * (to - from));
  }
  return s;
}

bool DraftSeries::solve_warm() {
  if (!solution_.converged || nlp::has_kinks(problem_)) return false;
  const std::vector<double> near = solution_.b;
  const nlp::FastOutcome outcome =
      solver_.solve(problem_, {near, kWarmGap, kWarmRoom, {}},
                    {.tolerance = tolerance_, .max_iterations = kWarmIterations});
  if (outcome != nlp::FastOutcome::converged) return false;
  solver_.fill(solution_);
  return true;
}

bool DraftSeries::solve_cold() {
  const nlp::RateEnvelope envelope = nlp::rate_envelope(problem_);
  if (envelope.blocked) return false;
  const double aim_s = kSlower * duration_of(problem_, envelope.fastest);
  solution_ = nlp::solve_fast(problem_, first_guess(problem_, envelope, aim_s), {.tolerance = tolerance_});
  return solution_.converged;
}

std::optional<DraftSeries::Cost> DraftSeries::solve(const ProfileRequest& request) {
  request_ = request;
  if (senseless(*request_)) return std::nullopt;
  motion_.emplace(path_motion(*request_));
  problem_ = nlp::transcribe(*request_, *motion_, grid(*motion_, *request_), {}, nullptr);
  solution_.converged = solve_warm() || solve_cold();
  if (!solution_.converged) return std::nullopt;
  return Cost{solution_.objective, duration_of(problem_, solution_.b)};
}

PathSlopes DraftSeries::slopes() const {
  return nlp::lagrangian_slopes(problem_, *motion_, solution_, mandatory_);
}

}  // namespace joulepath
