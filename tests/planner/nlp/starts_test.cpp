// What the solvers begin with: the coarse problem, and the averaged profile under a jerk limit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/nlp/fast/coarse_problem.hpp"
#include "planner/nlp/transcription/forward_backward.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/nlp/transcription/jerk_program.hpp"
#include "planner/profile/first_guess.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::nlp {
namespace {

ProfileRequest curved() {
  const Robot robot = testing::nomad();
  return {.piece = Curve({BezierSegment({{{0, 0}, {1.5, 0}, {2.7, 1.2}, {2.7, 2.7}}})}),
          .plant = make_plant(robot),
          .limits = *robot.limits,
          .nodes = 41};
}

/// From rest to rest in closed form, with a start speed by halving.
TEST(FirstGuess, TakesTheTimeAsked) {
  for (const double start_rate : {0.0, 0.3}) {
    ProfileRequest request = curved();
    request.start_rate = start_rate;
    const PathMotion motion = path_motion(request);
    const Problem problem = transcribe(request, motion, make_grid(motion, request, 41), {}, nullptr);
    const RateEnvelope envelope = rate_envelope(problem);
    const double least_s = duration_of(problem, envelope.fastest);
    for (const double share : {1.05, 1.5, 20.0})
      EXPECT_NEAR(duration_of(problem, first_guess(problem, envelope, share * least_s)), share * least_s,
                  1e-9 * least_s)
          << start_rate;
  }
}

/// Every fifth node, and both ends; one segment carries the rows of all that it replaces.
TEST(CoarseProblem, KeepsEveryFewNodesAndEveryRow) {
  const ProfileRequest request = curved();
  const PathMotion motion = path_motion(request);
  const Problem fine = transcribe(request, motion, make_grid(motion, request, 41), {}, nullptr);
  constexpr std::size_t kTogether = 5;
  const CoarseProblem coarse = coarsen(fine, kTogether);
  ASSERT_EQ(coarse.node.front(), 0u);
  ASSERT_EQ(coarse.node.back(), fine.segment_count());
  EXPECT_LE(coarse.node.size(), fine.segment_count() / kTogether + 2);
  for (std::size_t i = 0; i + 1 < coarse.node.size(); ++i) {
    const std::size_t first = coarse.node[i], last = coarse.node[i + 1];
    ASSERT_LT(first, last);
    EXPECT_LE(last - first, kTogether);
    const Segment& segment = coarse.problem.segments[i];
    EXPECT_EQ(segment.s0, fine.s[first]);
    EXPECT_NEAR(segment.s0 + segment.ds, fine.s[last], 1e-12);
    for (std::size_t r = fine.first_row[first]; r < fine.first_row[last]; ++r)
      EXPECT_TRUE(std::any_of(
          coarse.problem.rows.begin() + static_cast<std::ptrdiff_t>(coarse.problem.first_row[i]),
          coarse.problem.rows.begin() + static_cast<std::ptrdiff_t>(coarse.problem.first_row[i + 1]),
          [&](const ActiveRow& row) {
            return row.term == fine.rows[r].term && row.row == fine.rows[r].row && row.segment == i;
          }));
  }
}

/// A function that is linear in s survives the way to the coarse nodes and back.
TEST(CoarseProblem, InterpolatesLinesExactly) {
  const ProfileRequest request = curved();
  const PathMotion motion = path_motion(request);
  const Problem fine = transcribe(request, motion, make_grid(motion, request, 41), {}, nullptr);
  const CoarseProblem coarse = coarsen(fine, 4);
  std::vector<double> line;
  for (const double s : fine.s) line.push_back(0.3 + 0.7 * s);
  const std::vector<double> back = coarse.prolonged(coarse.restricted(line), fine);
  ASSERT_EQ(back.size(), line.size());
  for (std::size_t k = 0; k < line.size(); ++k) EXPECT_NEAR(back[k], line[k], 1e-12);
}

/// Squares of the rate of a drive of 4 m with 0.5 m/s^2 up and down: a peak of 1.41 m/s.
Profile ramps() {
  std::vector<double> s, b;
  for (int k = 0; k <= 40; ++k) {
    s.push_back(0.1 * k);
    b.push_back(2 * 0.5 * std::min(s.back(), 4.0 - s.back()));
  }
  return profile_from_squares(s, b);
}

TEST(AveragedMotion, KeepsTheDistanceOfEachSegment) {
  const Profile profile = ramps();
  const JerkMotion motion = averaged_motion(profile, 0.5);
  ASSERT_EQ(motion.dt.size() + 1, profile.s.size());
  EXPECT_EQ(motion.u.front(), profile.rate.front());
  EXPECT_EQ(motion.u.back(), profile.rate.back());
  EXPECT_EQ(motion.a.front(), 0.0);
  EXPECT_EQ(motion.a.back(), 0.0);
  for (std::size_t k = 0; k < motion.dt.size(); ++k)
    EXPECT_NEAR(0.5 * (motion.u[k] + motion.u[k + 1]) * motion.dt[k], 0.1, 1e-12);
  EXPECT_NEAR(motion.duration_s(), profile.duration_s(), 0.2 * profile.duration_s());
}

/// Within a ramp the mean over a symmetric window is the value in its middle (of the rate, whose mean adds
/// nothing where it is linear in time); about the peak, the acceleration falls from one ramp's to the
/// other's.
TEST(AveragedMotion, IsTheMeanOverTheWindow) {
  const Profile profile = ramps();
  constexpr double kWindow_s = 0.5;
  const JerkMotion motion = averaged_motion(profile, kWindow_s);
  const double peak_s = profile.time_s[20];
  for (std::size_t k = 1; k + 1 < profile.s.size(); ++k) {
    const double t = profile.time_s[k];
    if (t < kWindow_s / 2 || t > profile.time_s.back() - kWindow_s / 2) continue;
    const double share = std::clamp((peak_s - t) / (kWindow_s / 2), -1.0, 1.0);
    EXPECT_NEAR(motion.a[k], 0.5 * share, 1e-9) << k;
    if (std::abs(share) < 1.0) continue;
    EXPECT_NEAR(motion.u[k], profile.rate[k], 1e-9) << k;
  }
}

}  // namespace
}  // namespace joulepath::nlp
