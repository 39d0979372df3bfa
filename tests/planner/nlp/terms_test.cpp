#include <gtest/gtest.h>

#include <cmath>

#include "model/limit_table.hpp"
#include "planner/motion/path_motion.hpp"
#include "planner/nlp/transcription/grid.hpp"
#include "planner/nlp/transcription/problem.hpp"
#include "planner/nlp/transcription/segment_jets.hpp"
#include "tests/support/random_profiles.hpp"

namespace joulepath::nlp {
namespace {

/// Segments of a tight corner, once with the affine model and once with effects that bend it.
struct Bench {
  ProfileRequest request;
  PathMotion motion;
  Problem problem;

  explicit Bench(ProfileRequest r)
      : request(std::move(r)),
        motion(path_motion(request)),
        problem(transcribe(request, motion, make_grid(motion, request, 40), {}, nullptr)) {}
};

ProfileRequest corner(bool bent) {
  joulepath::testing::RandomProfiles random(5);
  ProfileRequest request = random.next(joulepath::testing::PathClass::tight_corners);
  if (bent)
    request.plant =
        make_plant(request.plant.robot,
                   {{.name = "stribeck_friction", .parameters = {{"torque_Nm", 0.1}, {"speed_rad_s", 1.5}}},
                    {.name = "gear_efficiency", .parameters = {{"loss_fraction", 0.1}}},
                    {.name = "driver_voltage_drop", .parameters = {{"voltage_V", 0.3}}},
                    {.name = "quadratic_drag", .parameters = {{"coefficient_N_s2_m2", 2.0}}}});
  return request;
}

template <class Term>
Term make_term(const Limits& limits) {
  if constexpr (requires { Term{limits}; })
    return Term{limits};
  else
    return Term{};
}

/// Differences over a step of 1e-5 are themselves wrong by up to 1e-4 where a rounded kink is near.
void expect_near(double exact, double differenced, double scale, const char* what, bool bent) {
  const double relative = bent ? 1e-4 : 2e-6;
  EXPECT_NEAR(exact, differenced, relative * (std::abs(exact) + std::abs(differenced)) + 1e-6 * scale)
      << what;
}

template <class Term>
class EveryTerm : public ::testing::Test {};

/// The formulation's own list: a new term in it is tested here.
template <class Tuple>
struct AsTypes;
template <class... Terms>
struct AsTypes<std::tuple<Terms...>> {
  using type = ::testing::Types<Terms..., Energy, Time>;
};
TYPED_TEST_SUITE(EveryTerm, AsTypes<Rows>::type);

TEST(Rows, AreNamedAsTheLimitsOfTheTable) {
  const auto has_row = [](std::string_view name) {
    EXPECT_NE(limit_named(name), nullptr) << name;
    return true;
  };
  std::apply([&](const auto&... term) { return (has_row(term.name) && ...); }, rows_for({}));
}

/// Value by plain numbers, derivatives by central differences of first order jets' values.
TYPED_TEST(EveryTerm, HasExactDerivatives) {
  for (bool bent : {false, true}) {
    const Bench bench(corner(bent));
    const TypeParam term = make_term<TypeParam>(bench.request.limits);
    for (std::size_t k = 2; k + 2 < bench.problem.segment_count(); k += 3) {
      const Segment& segment = bench.problem.segments[k];
      const double b0 = 0.021, b1 = 0.034, h = 1e-5;
      for (std::size_t row = 0; row < TypeParam::rows; ++row) {
        const auto jet_at = [&](double x, double y) { return term(jet_interval(segment, x, y), row); };
        const auto value = [&](double x, double y) { return jet_at(x, y).value; };
        const Jet jet = jet_at(b0, b1);
        // Kinks of gear and driver are rounded for derivatives (model/operating_point.hpp): values differ a
        // little.
        const double plain = term(plain_interval(segment, b0, b1), row);
        EXPECT_NEAR(jet.value, plain, bent ? 0.05 * (1 + std::abs(plain)) : 2e-6 * std::abs(plain) + 1e-6)
            << "value";
        const double scale = std::abs(jet.value) / b0;
        expect_near(jet.d[0], (value(b0 + h, b1) - value(b0 - h, b1)) / (2 * h), scale, "d0", bent);
        expect_near(jet.d[1], (value(b0, b1 + h) - value(b0, b1 - h)) / (2 * h), scale, "d1", bent);
        const double curve = (std::abs(jet.d[0]) + std::abs(jet.d[1])) / b0;
        expect_near(jet.dd[0], (jet_at(b0 + h, b1).d[0] - jet_at(b0 - h, b1).d[0]) / (2 * h), curve, "d00",
                    bent);
        expect_near(jet.dd[1], (jet_at(b0, b1 + h).d[0] - jet_at(b0, b1 - h).d[0]) / (2 * h), curve, "d01",
                    bent);
        expect_near(jet.dd[2], (jet_at(b0, b1 + h).d[1] - jet_at(b0, b1 - h).d[1]) / (2 * h), curve, "d11",
                    bent);
      }
    }
  }
}

/// The same terms between nodes of constant jerk: five unknowns.
TYPED_TEST(EveryTerm, HasExactDerivativesUnderConstantJerk) {
  constexpr std::size_t kUnknowns = 5;
  for (bool bent : {false, true}) {
    const Bench bench(corner(bent));
    const TypeParam term = make_term<TypeParam>(bench.request.limits);
    for (std::size_t k = 2; k + 2 < bench.problem.segment_count(); k += 9) {
      const Segment& segment = bench.problem.segments[k];
      const std::array<double, kUnknowns> x{0.15, 0.21, 0.18, 0.3, 0.2};
      for (std::size_t row = 0; row < TypeParam::rows; ++row) {
        const JerkJet jet = term(jet_jerk_interval(segment, x), row);
        const double scale = std::abs(jet.value), h = 1e-5;
        for (std::size_t i = 0, at = 0; i < kUnknowns; ++i) {
          auto low = x, high = x;
          low[i] -= h;
          high[i] += h;
          const JerkJet before = term(jet_jerk_interval(segment, low), row);
          const JerkJet after = term(jet_jerk_interval(segment, high), row);
          expect_near(jet.d[i], (after.value - before.value) / (2 * h), 10 * scale, "gradient", bent);
          for (std::size_t j = 0; j <= i; ++j, ++at)
            expect_near(jet.dd[at], (after.d[j] - before.d[j]) / (2 * h), 100 * scale + std::abs(jet.d[j]),
                        "Hessian", bent);
        }
      }
    }
  }
}

/// Kinematics by themselves: a motion of constant jerk leaves no defect, and its states are those in time.
TEST(JerkInterval, AMotionOfConstantJerkHasNoDefect) {
  const double u0 = 0.3, a0 = -0.2, jerk = 0.7, dt = 0.6;
  const auto u = [&](double t) { return u0 + a0 * t + jerk * t * t / 2; };
  const Segment segment{.ds = u0 * dt + a0 * dt * dt / 2 + jerk * dt * dt * dt / 6};
  const JerkInterval<double> interval{segment, u0, a0, u(dt), a0 + jerk * dt, dt};
  EXPECT_NEAR(interval.speed_defect(), 0, 1e-15);
  EXPECT_NEAR(interval.distance_defect(), 0, 1e-15);
  for (double tau : {0.0, 0.3, 1.0}) {
    EXPECT_NEAR(interval.at(tau).u, u(tau * dt), 1e-15);
    EXPECT_NEAR(interval.at(tau).a, a0 + jerk * tau * dt, 1e-15);
  }
}

void expect_same(const Jet& x, const Jet& y) {
  const auto near = [](double a, double b, double scale) { EXPECT_NEAR(a, b, 1e-9 * (std::abs(a) + scale)); };
  near(x.value, y.value, 1e-3);
  near(x.d[0], y.d[0], 1);
  near(x.d[1], y.d[1], 1);
  near(x.dd[0], y.dd[0], 100);
  near(x.dd[1], y.dd[1], 100);
  near(x.dd[2], y.dd[2], 100);
}

TEST(JetOf, ANumberMinusAJetTurnsItsSigns) {
  const Jet x = Jet::variable(0, 3.0), difference = 5.0 - x * x;
  EXPECT_EQ(difference.value, -4.0);
  EXPECT_EQ(difference.d[0], -6.0);
  EXPECT_EQ(difference.dd[0], -2.0);
}

TEST(SegmentJets, WrittenOutEqualForwardMode) {
  for (PowerSharing sharing : {PowerSharing::wheel, PowerSharing::bus}) {
    ProfileRequest request = corner(false);
    request.plant.robot.power.sharing = sharing;
    const Bench bench(std::move(request));
    for (std::size_t k = 0; k < bench.problem.segment_count(); ++k) {
      const Segment& segment = bench.problem.segments[k];
      const double b0 = k == 0 ? 0.0 : 0.02, b1 = k + 1 == bench.problem.segment_count() ? 0.0 : 0.03;
      const SegmentJets jets = segment_jets(segment, b0, b1);
      const auto energy = Energy::both(jet_interval(segment, b0, b1));
      expect_same(jets.duration_s, Time{}(jet_interval(segment, b0, b1), 0));
      expect_same(jets.energy_J[0], energy[0]);
      expect_same(jets.energy_J[1], energy[1]);
    }
  }
}

}  // namespace
}  // namespace joulepath::nlp
