// The check of a profile between its nodes, against the limits at very many places.
#include "planner/profile/dense_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "planner/motion/limit_check.hpp"
#include "planner/motion/motion_energy.hpp"
#include "tests/support/nomad.hpp"

namespace joulepath::nlp {
namespace {

constexpr double kRate_m_s = 0.5;

/// A bend at constant speed whose greatest lateral acceleration is above the limit. It is not symmetric: no
/// grid of equal segments has its peak at a sample.
ProfileRequest fast_bend() {
  return {.piece = Curve({BezierSegment({{{0, 0}, {1.9, 0}, {2.7, 1.4}, {2.7, 2.7}}})}),
          .plant = make_plant(testing::nomad()),
          .limits = {.lateral_acceleration_m_s2 = 0.08}};
}

struct Constant {
  Problem problem{};
  Profile profile{};
};

/// Constant speed on a grid of equal segments.
Constant constant_speed_on(const ProfileRequest& request, const PathMotion& motion, std::size_t segments) {
  Constant drive;
  drive.problem.request = &request;
  drive.problem.segments.resize(segments);
  for (std::size_t k = 0; k <= segments; ++k)
    drive.problem.s.push_back(motion.length() * static_cast<double>(k) / static_cast<double>(segments));
  drive.profile =
      profile_from_squares(drive.problem.s, std::vector<double>(segments + 1, kRate_m_s * kRate_m_s));
  return drive;
}

/// Greatest use of any limit at very many places.
double greatest_use(const ProfileRequest& request, const PathMotion& motion, const Profile& profile) {
  double most = 0;
  constexpr int kPlaces = 20000;
  for (int i = 0; i < kPlaces; ++i)
    for_each_limit_use(motion, request.limits, request.speed_caps,
                       profile.at_s(motion.length() * (i + 0.5) / kPlaces), 0,
                       [&](std::string_view, double ratio) { most = std::max(most, ratio); });
  return most;
}

/// Wherever the peak lies between the samples of a segment. Samples alone miss up to 0.1 % of it here.
TEST(DenseCheck, FindsThePeakBetweenItsSamples) {
  const ProfileRequest request = fast_bend();
  const PathMotion motion = path_motion(request);
  for (std::size_t segments = 2; segments <= 12; ++segments) {
    const Constant drive = constant_speed_on(request, motion, segments);
    const double most = greatest_use(request, motion, drive.profile);
    ASSERT_GT(most, 1.02);
    const DenseCheck check =
        check_densely(drive.problem, motion, drive.profile, std::vector<double>(segments, 0.0), 1e9);
    EXPECT_NEAR(check.worst_ratio, most, 1e-5 * most) << segments;
    ASSERT_FALSE(check.tighten.empty());
    double least_factor = 1;
    for (const Tightening& tightening : check.tighten)
      least_factor = std::min(least_factor, tightening.factor);
    EXPECT_NEAR(least_factor * check.worst_ratio, 1, 1e-6);
    EXPECT_LT(least_factor * check.worst_ratio, 1) << "a little below the limit";
    EXPECT_TRUE(std::ranges::any_of(check.cut, std::identity{}));
  }
}

/// The error is that of the sum; segments with a large error of their own are cut.
TEST(DenseCheck, ComparesTheCountedEnergyWithTheExactOne) {
  ProfileRequest request = fast_bend();
  request.limits = {};
  const PathMotion motion = path_motion(request);
  constexpr std::size_t kSegments = 6;
  const Constant drive = constant_speed_on(request, motion, kSegments);
  std::vector<double> counted_J;
  for (std::size_t k = 0; k < kSegments; ++k) counted_J.push_back(segment_energy_J(motion, drive.profile, k));
  const double exact_J = std::accumulate(counted_J.begin(), counted_J.end(), 0.0);
  ASSERT_GT(exact_J, 1.0);
  const auto check = [&] { return check_densely(drive.problem, motion, drive.profile, counted_J, 1e-3); };
  EXPECT_NEAR(check().energy_J, exact_J, 1e-12 * exact_J);
  EXPECT_NEAR(check().energy_error_J, 0, 1e-12 * exact_J);
  EXPECT_TRUE(std::ranges::none_of(check().cut, std::identity{}));
  counted_J[2] -= 0.01 * exact_J;
  EXPECT_NEAR(check().energy_error_J, 0.01 * exact_J, 1e-9 * exact_J);
  EXPECT_EQ(check().cut, (std::vector<bool>{false, false, true, false, false, false}));
  counted_J[4] += 0.01 * exact_J;
  EXPECT_NEAR(check().energy_error_J, 0, 1e-9 * exact_J) << "errors of opposite signs cancel";
}

}  // namespace
}  // namespace joulepath::nlp
