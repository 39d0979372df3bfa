// Predictions of a model for measured motions, and their rows, against the laws that they state.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "diagnosis/prediction/candidates.hpp"
#include "diagnosis/prediction/contact_creep.hpp"
#include "diagnosis/prediction/rows.hpp"
#include "diagnosis/where/localize.hpp"
#include "model/mean_power.hpp"
#include "tests/support/nomad.hpp"
#include "tests/support/synthetic_log.hpp"

namespace joulepath {
namespace {

using testing::nomad;

RunSignals weaving(const Robot& truth, double speed_m_s = 0.5) {
  const Run run =
      testing::synthetic_run(truth, "weaving", 15, 3.0, testing::swinging(speed_m_s, 0.2, 1.1, 0.5));
  return make_run_signals(run, 0, nomad());
}

ModelPoint with_effect(const EffectSetting& effect) { return {.robot = nomad(), .effects = {effect}}; }

TEST(Prediction, OfTheTrueModelIsTheLog) {
  for (const double speed_m_s : {0.5, -0.5}) {
    const RunSignals run = weaving(nomad(), speed_m_s);
    const ModelPoint truth{.robot = nomad()};
    const ResidualRows rows = residual_rows(run, truth, predict(run, truth));
    for (const Channel channel : {kCurrentLeft, kCurrentRight, kWindingLeft, kWindingRight}) {
      EXPECT_TRUE(rows.present.col(channel).any()) << kChannelNames[static_cast<std::size_t>(channel)];
      // At both ends of the log the kernel is cut off.
      EXPECT_LT(rows.value.col(channel).segment(3, run.size() - 6).cwiseAbs().maxCoeff(), 2e-3);
    }
    for (const Channel channel : {kDriverPower, kSupplyVoltage, kGyro, kHeading, kPositionX, kPositionY})
      EXPECT_FALSE(rows.present.col(channel).any()) << "not in the log";
  }
}

/// Friction of 0.05 N m more costs 0.05/(Kt n) A against the motion; the winding's equation still holds.
TEST(Prediction, OfFrictionChangesTheCurrentAndNotTheWinding) {
  const double extra_A = 0.05 / nomad().motor.left.torque_per_ampere_Nm_A();
  for (const double speed_m_s : {0.5, -0.5}) {
    const RunSignals run = weaving(nomad(), speed_m_s);
    const ModelPoint nominal{.robot = nomad()};
    const Prediction base = predict(run, nominal),
                     more = predict(
                         run, with_effect({.name = "coulomb_friction", .parameters = {{"torque_Nm", 0.05}}}));
    const Eigen::MatrixXd rows = signature_rows(run, nominal, base, more);
    for (Eigen::Index j = 0; j < run.size(); ++j)
      for (int s : {0, 1}) {
        EXPECT_NEAR(rows(j, kCurrentLeft + s), std::copysign(extra_A, speed_m_s), 1e-9);
        EXPECT_NEAR(rows(j, kWindingLeft + s), 0.0, 1e-9);
      }
  }
}

/// R (1 + 0.1) needs 0.1 R i more voltage and no more current.
TEST(Prediction, OfResistanceChangesTheWindingAndNotTheCurrent) {
  const RunSignals run = weaving(nomad());
  const ModelPoint nominal{.robot = nomad()};
  const Prediction base = predict(run, nominal),
                   hot = predict(run, with_effect({.name = "winding_resistance_error",
                                                   .parameters = {{"fraction", 0.1}}}));
  const Eigen::MatrixXd rows = signature_rows(run, nominal, base, hot);
  for (Eigen::Index j = 0; j < run.size(); ++j) {
    EXPECT_NEAR(rows(j, kCurrentLeft), 0.0, 1e-12);
    EXPECT_NEAR(rows(j, kWindingLeft), 0.1 * nomad().motor.left.resistance_ohm * base.current_A.left[j],
                1e-9);
    // The mean of i^2 over the kernel is at least the square of its mean, and here hardly more.
    const double more_W = hot.power_W.left[j] - base.power_W.left[j],
                 of_the_mean_W =
                     0.1 * nomad().motor.left.resistance_ohm * std::pow(base.current_A.left[j], 2);
    EXPECT_GE(more_W, of_the_mean_W - 1e-9);
    EXPECT_NEAR(more_W, of_the_mean_W, 1e-4);
  }
}

/// A body whose wheels slip lags behind them: at 400 N s/m by 29 kg/(2 400 N s/m) = 36 ms.
TEST(Prediction, OfSlipKnowsTheLagOfTheBody) {
  for (const double stiffness_N_s_m : {100.0, 400.0, 1500.0}) {
    Robot truth = nomad();
    truth.inertia.wheel_axle_inertia_kg_m2 = 0;  // the log's wheels turn without inertia of their own
    const EffectSetting slip{.name = "wheel_slip",
                             .parameters = {{"creep_stiffness_N_s_m", stiffness_N_s_m}}};
    Robot slipping = truth;
    slipping.effects = {slip};
    const joulepath::Run drive =
        testing::synthetic_run(slipping, "weaving", 15, 3.0, testing::swinging(0.5, 0.2, 3.0, 0.5, 2.0));
    const RunSignals run = make_run_signals(drive, 0, truth);
    const auto worst_A = [&](const ModelPoint& point) {
      const Prediction p = predict(run, point);
      return (run.motor_current_A.left - p.current_A.left).segment(5, run.size() - 10).cwiseAbs().maxCoeff();
    };
    EXPECT_LT(worst_A({.robot = slipping}), 0.05 * worst_A({.robot = truth})) << stiffness_N_s_m;
  }
}

/// Creeping wheels turn ahead of the body, which takes a current for their own inertia; V = R i + K q' holds.
TEST(Prediction, OfCreepingWheelsKeepsTheWindingsEquation) {
  const RunSignals run = weaving(nomad());
  const Prediction rigid = predict(run, {.robot = nomad()}),
                   creeping = predict(run, with_effect({.name = "wheel_slip",
                                                        .parameters = {{"creep_stiffness_N_s_m", 400.0}}}));
  EXPECT_GT((creeping.current_A.left - rigid.current_A.left).cwiseAbs().maxCoeff(), 1e-3);
  for (Side side : kSides) {
    const Motor motor = nomad().motor[side];
    for (Eigen::Index j = 1; j < run.size(); ++j)  // the first sample's past is unknown
      EXPECT_NEAR(creeping.voltage_V[side][j],
                  motor.resistance_ohm * creeping.current_A[side][j] +
                      motor.volts_per_speed_V_s_rad() * run.wheel_speed_rad_s[side][j],
                  1e-9);
  }
}

/// y' + y / lag = ramp / lag: behind a ramp by slope times lag once the start has decayed; at once without
/// lag.
TEST(Lagged, FollowsARampBehindItByTheLag) {
  constexpr Eigen::Index kCount = 40;
  constexpr double kPeriod = 0.1, kSlope = 3.0;
  const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(kCount, 0, kSlope * kPeriod * (kCount - 1)),
                        slope = Eigen::VectorXd::Constant(kCount, kSlope);
  for (const double lag_s : {0.0, 1e-6, 0.02, 0.1, 0.4}) {
    const Lagged y = lagged(ramp, slope, Eigen::VectorXd::Constant(kCount, lag_s), kPeriod);
    for (Eigen::Index j = 1; j < kCount; ++j) {
      const double t = kPeriod * static_cast<double>(j);
      const double decayed = lag_s > 0 ? std::exp(-t / lag_s) : 0.0;
      EXPECT_NEAR(y.value[j], kSlope * (t - lag_s * (1 - decayed)), 1e-12) << lag_s;
      EXPECT_NEAR(y.rate[j], kSlope * (1 - decayed), 1e-12) << lag_s;
    }
  }
}

/// The mean of a product is not the product of the means: while the wheels accelerate, nine tenths of the
/// difference are known.
TEST(Prediction, OfThePowerIsTheMeanOfTheProduct) {
  for (const double rate_rad_s : {2.0, 4.0}) {
    const joulepath::Run drive = testing::synthetic_run(nomad(), "swinging", 15, 3.0,
                                                        testing::swinging(0.6, 0.3, rate_rad_s, 0.8, 3.0));
    RunSignals run = make_run_signals(drive, 0, nomad());
    run.motor_covariance_W = {};  // what the log shows of the samples
    const Prediction p = predict(run, {.robot = nomad()});
    for (Side side : kSides) {
      const Eigen::Index inner = run.size() - 6;
      const Eigen::VectorXd
          logged_W = run.motor_power_W[side].segment(3, inner),
          plain_W = run.motor_voltage_V[side].cwiseProduct(run.motor_current_A[side]).segment(3, inner);
      EXPECT_LT((p.power_W[side].segment(3, inner) - logged_W).norm(), 0.1 * (plain_W - logged_W).norm());
    }
  }
}

/// Standby and both motors; nothing comes back where regeneration has efficiency 0.
TEST(Prediction, OfTheBatteryIsStandbyAndMotors) {
  RunSignals run = weaving(nomad());
  run.motors_at_supply = {};  // what the log shows of the samples
  const Prediction p = predict(run, {.robot = nomad()});
  for (Eigen::Index j = 0; j < run.size(); ++j)
    EXPECT_NEAR(p.battery_power_W[j],
                nomad().power.standby_W + mean_positive_W(p.power_W.left[j], p.power_change_W.left[j]) +
                    mean_positive_W(p.power_W.right[j], p.power_change_W.right[j]),
                1e-9);
}

/// The strength of each effect, as an amplitude of the search, is written to a setting and read back.
TEST(Candidates, AmplitudesSurviveTheirSetting) {
  for (const Candidate& candidate : catalog_candidates(nomad())) {
    std::vector<double> amplitudes = candidate.step;
    if (amplitudes.size() == 2) amplitudes[1] *= -0.5;
    const std::vector<double> back = amplitudes_of(setting_of(candidate, amplitudes, nomad()), nomad());
    ASSERT_EQ(back.size(), amplitudes.size()) << candidate.label();
    for (std::size_t k = 0; k < back.size(); ++k)
      EXPECT_NEAR(back[k], amplitudes[k], 1e-12 * std::abs(amplitudes[k])) << candidate.label();
  }
}

TEST(Candidates, CoverTheCatalogOnceForEachSideWithoutWhatIsTakenOut) {
  std::set<std::string> labels, without{"coulomb_friction", "dragging_wheel"};
  for (const Candidate& candidate : catalog_candidates(nomad(), without)) {
    EXPECT_FALSE(without.contains(candidate.shape.name));
    EXPECT_EQ(candidate.effect().has_side, candidate.shape.side.has_value());
    EXPECT_EQ(candidate.amplitude.size(), candidate.step.size());
    labels.insert(candidate.label());
  }
  std::size_t expected = 0;
  for (const EffectDescription& effect : effect_catalog())
    if (!effect.has_region && !without.contains(std::string(effect.info.name)))
      expected += effect.has_side ? 2 : 1;
  EXPECT_EQ(labels.size(), expected);
}

/// A gap of one wheel only, in a run forward and one in reverse: shares add up to 1 on each axis.
TEST(Localization, FindsTheWheelAndTheDirection) {
  Robot worn = nomad();
  worn.motor.left.friction_torque_Nm *= 1.3;
  std::vector<RunSignals> signals{weaving(worn, 0.5), weaving(nomad(), -0.5)};
  signals[1].name = "back";
  const std::vector<WhereCell> cells = localize_gap(signals, {.robot = nomad()}, NoiseModel{}, 20);
  std::map<std::string, double> sum, share;
  for (const WhereCell& cell : cells) {
    sum[cell.axis] += cell.share_of_gap;
    share[cell.axis + " " + cell.value] = cell.share_of_gap;
  }
  for (const char* axis : {"phase", "wheel", "speed", "payload", "direction", "channel", "run"})
    EXPECT_NEAR(sum[axis], 1.0, 1e-9) << axis;
  EXPECT_EQ(sum.count("floor") + sum.count("time_of_day"), 0u) << "neither is in the log";
  EXPECT_GT(share["wheel left"], 0.98);
  EXPECT_GT(share["direction forward"], 0.98);
  EXPECT_GT(share["run weaving"], 0.98);
  EXPECT_GT(share["channel current"], 0.9);
}

/// Noise of A and of V in the power V i, of which the rest of the winding's equation holds V - R i; what it
/// makes of a mean size is no gap.
TEST(Localization, TakesTheSensorsNoiseOffTheGap) {
  Robot worn = nomad();
  for (Side side : kSides) worn.motor[side].friction_torque_Nm *= 1.5;
  const RunSignals run = weaving(worn);
  const Prediction p = predict(run, {.robot = nomad()});
  const auto gap_J = [&](const NoiseModel& noise) {
    for (const WhereCell& cell : localize_gap({run}, {.robot = nomad()}, noise, 1))
      if (cell.axis == "run") return cell.energy_J;
    throw std::runtime_error("no cell of the run");
  };
  for (const auto& [sd_A, sd_V] : {std::pair{0.01, 0.02}, {0.0, 0.02}, {0.02, 0.05}}) {
    NoiseModel noise{};
    for (const Channel side : {kCurrentLeft, kCurrentRight}) noise.channel_sd[side] = sd_A;
    const double ohm = nomad().motor.left.resistance_ohm;
    for (const Channel side : {kWindingLeft, kWindingRight})
      noise.channel_sd[side] = std::hypot(sd_V, ohm * sd_A);
    const auto half = std::lround(kGapWindow_s / run.period_s);
    double noise_J = 0;
    for (Side side : kSides)
      for (Eigen::Index j = 0; j < run.size(); ++j) {
        const auto samples =
            std::min<Eigen::Index>(run.size() - 1, j + half) - std::max<Eigen::Index>(0, j - half) + 1;
        noise_J += run.period_s * std::sqrt(2 / std::numbers::pi / static_cast<double>(samples)) *
                   std::hypot(p.voltage_V[side][j] * sd_A, p.current_A[side][j] * sd_V);
      }
    EXPECT_NEAR(gap_J({}) - gap_J(noise), noise_J, 1e-9 * noise_J) << sd_A << " A, " << sd_V << " V";
  }
}

/// A gap below the noise of a sample, for long, and a large one, shortly: their shares are those without
/// noise, also where the noise has a memory.
TEST(Localization, KeepsSmallGapsThatLast) {
  constexpr double kSd_A = 0.025, kMemory = 0.5;
  Robot heavy = nomad();
  heavy.inertia.chassis_mass_kg *= 1.25;
  for (Side side : kSides) heavy.motor[side].friction_torque_Nm *= 1.1;
  const auto ramps = [](double t) {
    const double acceleration_m_s2 = t < 1 ? 0.5 : t < 13 ? 0.0 : t < 14 ? -0.5 : 0.0;
    const double speed_m_s = std::clamp(std::min(0.5 * t, 0.5 * (14 - t)), 0.0, 0.5);
    return BodyMotion<double>{.speed_m_s = speed_m_s, .acceleration_m_s2 = acceleration_m_s2};
  };
  std::vector<RunSignals> clean, noisy;
  std::mt19937_64 random(3);
  for (int i = 0; i < 6; ++i) {
    clean.push_back(make_run_signals(testing::synthetic_run(heavy, "ramps", 15, 0.0, ramps), 0, nomad()));
    noisy.push_back(clean.back());
    const Prediction p = predict(clean.back(), {.robot = nomad()});
    std::normal_distribution<double> fresh_A(0.0, kSd_A * std::sqrt(1 - kMemory * kMemory));
    for (Side side : kSides) {
      double error_A = 0;
      for (Eigen::Index j = 0; j < noisy.back().size(); ++j) {
        error_A = kMemory * error_A + fresh_A(random);
        noisy.back().motor_power_W[side][j] += p.voltage_V[side][j] * error_A;
      }
    }
  }
  NoiseModel noise{};
  for (const Channel side : {kCurrentLeft, kCurrentRight}) {
    noise.channel_sd[side] = kSd_A;
    noise.memory[side] = {.coefficient = {kMemory, 0.0}};
  }
  const auto shares = [](const std::vector<RunSignals>& runs, const NoiseModel& of) {
    std::map<std::string, double> share;
    for (const WhereCell& cell : localize_gap(runs, {.robot = nomad()}, of, 1))
      if (cell.axis == "phase") share[cell.value] = cell.share_of_gap;
    return share;
  };
  auto truth = shares(clean, NoiseModel{}), found = shares(noisy, noise);
  EXPECT_GT(truth["cruise"], 1.25 * truth["accelerate"]);
  for (const char* phase : {"cruise", "accelerate", "brake"})
    EXPECT_NEAR(found[phase], truth[phase], 0.15) << phase;
}

/// A driven wheel creeps: uphill the body travels less than its wheels roll.
TEST(Prediction, OfCreepingWheelsFallsBehindThem) {
  const EffectSetting slope{.name = "floor_slope",
                            .parameters = {{"grade", 0.02}, {"uphill_direction_rad", 0.0}}};
  const EffectSetting slip{.name = "wheel_slip", .parameters = {{"creep_stiffness_N_s_m", 2000.0}}};
  const RunSignals run = make_run_signals(
      testing::synthetic_run(nomad(), "lane", 15, 3.0, testing::swinging(0.5, 0.1, 1.1)), 0, nomad());
  const auto travelled_m = [&](const std::vector<EffectSetting>& effects) {
    const Prediction p = predict(run, {.robot = nomad(), .effects = effects});
    return p.x_m[p.x_m.size() - 1] - p.x_m[0];
  };
  const double with_m = travelled_m({slope, slip}), without_m = travelled_m({slope});
  // Force per wheel over the stiffness, over the time; the force of the acceleration nearly cancels.
  const double force_N = 0.02 * (21.2 + 2 * 1.39 + 3.0) * 9.81 / 2;
  EXPECT_NEAR(without_m - with_m, force_N / 2000.0 * 15, 0.2 * force_N / 2000.0 * 15);
}

/// A driver takes its drop from the motor in the direction of the current, whichever that is.
TEST(Prediction, OfADriversDropHasTheSignOfTheCurrent) {
  for (const double speed_m_s : {0.5, -0.5}) {
    const RunSignals run = weaving(nomad(), speed_m_s);
    const Prediction base = predict(run, {.robot = nomad()}),
                     more = predict(run, with_effect({.name = "driver_voltage_drop",
                                                      .parameters = {{"voltage_V", 0.3}}}));
    Eigen::Index greatest;
    base.current_A.left.cwiseAbs().maxCoeff(&greatest);
    EXPECT_NEAR(more.voltage_V.left[greatest] - base.voltage_V.left[greatest],
                std::copysign(0.3, base.current_A.left[greatest]), 0.01);
  }
}

}  // namespace
}  // namespace joulepath
