#pragma once

#include <algorithm>
#include <vector>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"

namespace joulepath {

/// The input of a solver: the grid's problem and a strictly feasible guess.
struct PreparedProblem {
  ProfileRequest request;
  PathMotion motion;
  nlp::Problem problem;
  std::vector<double> guess{};

  explicit PreparedProblem(const ProfileRequest& r, std::size_t nodes)
      : request(r), motion(path_motion(request)) {
    problem = nlp::transcribe(request, motion, nlp::make_grid(motion, request, nodes), {}, nullptr);
    guess = nlp::rate_envelope(problem).fastest;
    const double fastest_s = nlp::duration_of(problem, guess);
    const double aim_s = std::min(1.5 * fastest_s, 0.1 * fastest_s + 0.9 * problem.duration_s);
    for (std::size_t k = 1; k + 1 < guess.size(); ++k) guess[k] *= (fastest_s / aim_s) * (fastest_s / aim_s);
  }
  PreparedProblem(const PreparedProblem&) = delete;
  PreparedProblem& operator=(const PreparedProblem&) = delete;
};

}  // namespace joulepath
