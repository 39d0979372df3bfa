#include <gtest/gtest.h>

#include <cmath>

#include "planner/motion/path_motion.hpp"
#include "planner/nlp/fast/fast_solver.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath::nlp {
namespace {

/// 240 random problems of all four classes; standby makes them convex, so that both have to agree, and Ipopt
/// from the fast solution needs few iterations.
TEST(FastSolver, FindsTheOptimumOfIpopt) {
  joulepath::testing::RandomProfiles random(2024);
  int fast_iterations = 0, cold_iterations = 0, warm_iterations = 0;
  for (int i = 0; i < 240; ++i) {
    ProfileRequest request = random.next(joulepath::testing::kPathClasses[i % 4]);
    const double factor = random.uniform(1.05, 2);
    const PathMotion motion = path_motion(request);
    const std::vector<double> grid = make_grid(motion, request, 40);
    request.time = {TimeMode::minimum_time};
    const RateEnvelope envelope = rate_envelope(transcribe(request, motion, grid, {}, nullptr));
    ASSERT_FALSE(envelope.blocked.has_value()) << i;
    const Problem timed = transcribe(request, motion, grid, {}, nullptr);
    if (i % 3 == 0)
      request.time = {TimeMode::free_time};
    else
      request.time = {TimeMode::time_budget, factor * duration_of(timed, envelope.fastest)};
    const Problem problem = transcribe(request, motion, grid, {}, nullptr);
    std::vector<double> guess = envelope.fastest;
    for (std::size_t k = 1; k + 1 < guess.size(); ++k) guess[k] /= factor * factor * 0.99;
    const Solution fast = solve_fast(problem, guess), reference = solve_with_ipopt(problem, guess);
    ASSERT_TRUE(reference.converged) << i << " " << reference.message;
    ASSERT_TRUE(fast.converged) << i << " " << fast.message;
    EXPECT_NEAR(fast.objective, reference.objective, 1e-6 * std::abs(reference.objective)) << i;
    EXPECT_NEAR(fast.price_W, reference.price_W, 1e-3 * (1 + std::abs(reference.price_W))) << i;
    const Solution warm = solve_with_ipopt(problem, fast.b, {.warm = true, .near = &fast});
    ASSERT_TRUE(warm.converged) << i << " " << warm.message;
    EXPECT_NEAR(warm.objective, reference.objective, 1e-7 * std::abs(reference.objective)) << i;
    fast_iterations += fast.iterations;
    cold_iterations += reference.iterations;
    warm_iterations += warm.iterations;
  }
  RecordProperty("fast_iterations", fast_iterations);
  RecordProperty("cold_iterations", cold_iterations);
  RecordProperty("warm_iterations", warm_iterations);
  EXPECT_LT(2 * warm_iterations, cold_iterations) << "the fast solver's multipliers save most iterations";
}

/// On a fine grid the fast solver starts from a coarser one of its own.
TEST(FastSolver, FindsTheOptimumOfIpoptOnAFineGrid) {
  joulepath::testing::RandomProfiles random(77);
  for (int i = 0; i < 8; ++i) {
    ProfileRequest request = random.next(joulepath::testing::kPathClasses[i % 4]);
    const PathMotion motion = path_motion(request);
    const std::vector<double> grid = make_grid(motion, request, 1000);
    const RateEnvelope envelope = rate_envelope(transcribe(request, motion, grid, {}, nullptr));
    ASSERT_FALSE(envelope.blocked.has_value()) << i;
    const Problem free = transcribe(request, motion, grid, {}, nullptr);
    if (i % 3 != 0) request.time = {TimeMode::time_budget, 1.3 * duration_of(free, envelope.fastest)};
    const Problem problem = transcribe(request, motion, grid, {}, nullptr);
    std::vector<double> guess = envelope.fastest;
    for (std::size_t k = 1; k + 1 < guess.size(); ++k) guess[k] /= 1.6;
    const Solution fast = solve_fast(problem, guess), reference = solve_with_ipopt(problem, guess);
    ASSERT_TRUE(reference.converged) << i << " " << reference.message;
    ASSERT_TRUE(fast.converged) << i << " " << fast.message;
    EXPECT_NEAR(fast.objective, reference.objective, 1e-6 * std::abs(reference.objective)) << i;
  }
}

}  // namespace
}  // namespace joulepath::nlp
