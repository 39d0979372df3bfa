#include "diagnosis/evidence/signatures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/prediction/body_swing.hpp"
#include "diagnosis/prediction/rows.hpp"
#include "diagnosis/thresholds.hpp"
#include "model/limit_table.hpp"

namespace joulepath {
namespace {

bool is_active(const Candidate& candidate, const ModelState& state, std::size_t& index) {
  for (index = 0; index < state.effects.size(); ++index)
    if (state.effects[index].candidate.label() == candidate.label()) return true;
  return false;
}

/// The state with one candidate's amplitudes; replaces the active effect with the same label.
ModelState with_effect(ModelState state, const Candidate& candidate, const std::vector<double>& amplitude) {
  std::size_t index;
  if (is_active(candidate, state, index))
    state.effects[index] = {candidate, amplitude};
  else
    state.effects.push_back({candidate, amplitude});
  return state;
}

/// Central difference of predictions with respect to one parameter.
template <class PredictAt>
Eigen::MatrixXd difference(const RunSignals& signals, const ModelPoint& point, const Prediction& base,
                           double low, double high, PredictAt&& predict_at) {
  const Eigen::MatrixXd up = signature_rows(signals, point, base, predict_at(high));
  if (low == 0) return up / high;
  return (up - signature_rows(signals, point, base, predict_at(low))) / (high - low);
}

/// Of a derivative of sixth order over whole samples, for one, two and three samples on either side.
constexpr std::array<double, 3> kSlopeWeight{45.0 / 60, -9.0 / 60, 1.0 / 60};

constexpr int kFormCount = static_cast<int>(kFormVariables.size());

/// A variable of kFormVariables, scaled to [-1, 1].
double form_variable(const RunSignals& s, const Geometry& geometry, int form, Eigen::Index j) {
  const BodyMotion<double> motion = s.rolled_motion(geometry, j);
  const auto scaled = [](double value, double usual) {
    return 2 * std::abs(value) / (std::abs(value) + usual) - 1;
  };
  switch (form) {
    case 0:
      return scaled(motion.speed_m_s, kUsualSpeed_m_s);
    case 1:
      return scaled(motion.yaw_rate_rad_s, kUsualYawRate_rad_s);
    case 2:
      return scaled(s.payload_kg[j], kUsualPayload_kg);
    case 3:
      return scaled(motion.acceleration_m_s2, kUsualAcceleration_m_s2);
    default:
      return scaled(s.time_of_day_s[j], kUsualTime_s);
  }
}

bool is_edge(const Candidate& candidate, const std::string& parameter) {
  return candidate.effect().find(parameter)->role == ParameterRole::edge;
}

/// Prior deviation of a shape parameter.
double shape_prior_sd(const Candidate& candidate, const std::string& parameter) {
  if (is_edge(candidate, parameter)) return kRegionStep_m;
  return kShapeSpread * std::abs(candidate.shape.parameters.at(parameter));
}

double shape_step(const Candidate& candidate, const std::string& parameter, double value) {
  return is_edge(candidate, parameter) ? 0.5 * kRegionStep_m : std::max(1e-3, 0.05 * std::abs(value));
}

class Differencer {
 public:
  Differencer(const RunSignals& signals, const Robot& robot, const std::vector<Nuisance>& nuisances,
              const ModelState& state, const Prediction& base)
      : signals_(signals),
        robot_(robot),
        nuisances_(nuisances),
        state_(state),
        base_(base),
        point_(model_point(robot, nuisances, state)) {}

  Eigen::MatrixXd nuisance(std::size_t k, double step) const {
    if (nuisances_[k].key == kSwingNuisance) return swing(swing_along(signals_, robot_.geometry));
    if (nuisances_[k].key == kYawSwingNuisance) return swing(swing_in_yaw(signals_, robot_.geometry));
    if (is_column_only(nuisances_[k])) return of_clock(nuisances_[k].key);
    if (nuisances_[k].key == kCreepNuisance) return usual_creep_m_s_N(robot_) * creep();
    return difference(signals_, point_, base_, -step, step, [&](double change) {
      ModelState changed = state_;
      changed.nuisance_fraction[k] += change;
      return at(changed);
    });
  }

  Eigen::MatrixXd amplitude(const Candidate& candidate, std::size_t part) const {
    if (candidate.effect().delays_channels) return delay();
    if (candidate.effect().info.stage == Stage::contact) return creep();
    const AmplitudeStep step = amplitude_step(state_, candidate, part);
    return difference(signals_, point_, base_, step.low, step.high,
                      [&](double change) { return at(with_change(state_, candidate, step, part, change)); });
  }

  Eigen::MatrixXd shape(const Candidate& candidate, const std::string& parameter) const {
    std::size_t index;
    if (!is_active(candidate, state_, index)) return {};
    const double value = candidate.shape.parameters.at(parameter);
    const ParameterDescription& accepted = *candidate.effect().find(parameter);
    const double step = shape_step(candidate, parameter, value), down = std::max(-step, accepted.min - value),
                 up = std::min(step, accepted.max - value);
    return difference(signals_, point_, base_, down, up, [&](double change) {
      Candidate moved = candidate;
      moved.shape.parameters[parameter] += change;
      return at(with_effect(state_, moved, state_.effects[index].amplitude));
    });
  }

  /// The contribution of an effect of the state, weighted by the variable.
  Eigen::MatrixXd form(const Candidate& candidate, int variable) const {
    std::size_t index;
    if (!is_active(candidate, state_, index)) return {};
    ModelState without = state_;
    without.effects.erase(without.effects.begin() + static_cast<std::ptrdiff_t>(index));
    Eigen::MatrixXd rows = -signature_rows(signals_, point_, base_, at(without));
    if (candidate.effect().delays_channels) rows = state_.effects[index].amplitude[0] * delay();
    return weighted(std::move(rows), variable);
  }

  /// A contribution times the form's variable. Poses are integrals along the way and stay unchanged.
  Eigen::MatrixXd weighted(Eigen::MatrixXd rows, int variable) const {
    for (Eigen::Index j = 0; j < rows.rows(); ++j)
      rows.row(j) *= form_variable(signals_, robot_.geometry, variable, j);
    for (Channel pose : {kHeading, kPositionX, kPositionY}) rows.col(pose).setZero();
    return rows;
  }

 private:
  /// Derivative by the creep of the tires, whether usual or an effect: one column. Two that differ in the
  /// second order were a filter of the wheels' noise, with opposite signs.
  Eigen::MatrixXd creep() const {
    const double usual = usual_creep_m_s_N(robot_),
                 now = make_plant(point_.robot, point_.effects).creep_m_s_N + point_.contact_creep_m_s_N;
    return difference(signals_, point_, base_, now < usual ? 0.0 : -usual, usual, [&](double change) {
      ModelPoint point = point_;
      point.contact_creep_m_s_N += change;
      return predict(signals_, point);
    });
  }

  /// Derivative by a swing, in its 1-sigma.
  Eigen::MatrixXd swing(BodyLag lag) const {
    lag *= kUsualSwing_s2;
    ModelPoint point = point_;
    point.swing = lag;
    return signature_rows(signals_, point_, base_, predict(signals_, point));
  }

  /// Derivative by an error of an instrument's clock, in its 1-sigma.
  Eigen::MatrixXd of_clock(const std::string& key) const {
    if (key == kStampNuisance) return kStampFraction * signals_.log_period_s * delay();
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(signals_.size(), kChannelCount);
    const ReadingPeriods& period_s = signals_.reading_period_s;
    if (key == kGyroStampNuisance)
      rows.col(kGyro) = -kReadingDelay * period_s.gyro_s * yaw_acceleration_rad_s2();
    if (key == kPoseStampNuisance) add_late_pose(-kReadingDelay * period_s.pose_s, rows);
    if (key == kBatteryStampNuisance)
      rows.col(kDriverPower) = -kReadingDelay * period_s.battery_s * slope(base_.battery_power_W);
    if (key == kBatteryMeanNuisance)
      rows.col(kDriverPower) = std::pow(period_s.battery_s, 2) / 12 * slope(slope(base_.battery_power_W));
    return rows;
  }

  /// A pose that is late by a time (s). A late heading also turns the way of the wheels:
  ///   d/dt (v cos h) = a cos h - v w sin h, so that x changes by the time's share of int a cos h dt.
  void add_late_pose(double late_s, Eigen::MatrixXd& rows) const {
    double along_x_m_s = 0, along_y_m_s = 0;
    for (Eigen::Index j = 0; j < signals_.size(); ++j) {
      const BodyMotion<double> motion = signals_.rolled_motion(robot_.geometry, j);
      const double cosine = std::cos(signals_.heading_rad[j]), sine = std::sin(signals_.heading_rad[j]);
      if (j == 0 || !signals_.heading_measured) {
        along_x_m_s = motion.speed_m_s * cosine;
        along_y_m_s = motion.speed_m_s * sine;
      } else {
        along_x_m_s += motion.acceleration_m_s2 * signals_.period_s * cosine;
        along_y_m_s += motion.acceleration_m_s2 * signals_.period_s * sine;
      }
      rows(j, kHeading) = late_s * motion.yaw_rate_rad_s;
      rows(j, kPositionX) = late_s * along_x_m_s;
      rows(j, kPositionY) = late_s * along_y_m_s;
    }
    remove_pose_means(rows);
  }

  /// By the kernel's slope: differences of rows flatten steep parts.
  Eigen::VectorXd yaw_acceleration_rad_s2() const {
    return Eigen::VectorXd::NullaryExpr(signals_.size(), [&](Eigen::Index j) {
      return signals_.rolled_motion(robot_.geometry, j).yaw_acceleration_rad_s2;
    });
  }

  /// Derivative of a channel by time, of sixth order; flat beyond its ends.
  Eigen::VectorXd slope(const Eigen::VectorXd& channel) const {
    const auto at = [&](Eigen::Index j) {
      return channel[std::clamp<Eigen::Index>(j, 0, channel.size() - 1)];
    };
    Eigen::VectorXd result = Eigen::VectorXd::Zero(channel.size());
    for (Eigen::Index j = 0; j < channel.size(); ++j)
      for (Eigen::Index k = 0; k < std::ssize(kSlopeWeight); ++k)
        result[j] +=
            kSlopeWeight[static_cast<std::size_t>(k)] / signals_.period_s * (at(j + k + 1) - at(j - k - 1));
    return result;
  }

  Prediction at(const ModelState& state) const {
    return predict(signals_, model_point(robot_, nuisances_, state));
  }

  /// Derivative by the delay. The signals are already read at the state's delay; the remaining delay shifts
  /// the predicted readings. A sixth-order difference over whole samples is used: half samples would blur the
  /// readings, and a lower order flattens steep parts, whose residual then imitates an acceleration.
  Eigen::MatrixXd delay() const {
    Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(signals_.size(), kChannelCount);
    for (std::size_t k = 0; k < kSlopeWeight.size(); ++k) {
      const double shift_s = static_cast<double>(k + 1) * signals_.period_s;
      slope += kSlopeWeight[k] / signals_.period_s *
               (signature_rows(signals_, point_, base_, shifted(shift_s)) -
                signature_rows(signals_, point_, base_, shifted(-shift_s)));
    }
    return slope;
  }

  Prediction shifted(double delay_s) const {
    ModelPoint point = point_;
    point.channel_delay_s += delay_s;
    return predict(signals_, point);
  }

  const RunSignals& signals_;
  const Robot& robot_;
  const std::vector<Nuisance>& nuisances_;
  const ModelState& state_;
  const Prediction& base_;
  ModelPoint point_;
};

/// Rows of a form: of an effect of the state at its strength, of any other one at its typical size.
Eigen::MatrixXd form_rows(const Differencer& differencer, const ModelState& state,
                          const std::vector<Candidate>& candidates, const std::vector<Column>& columns,
                          const std::vector<Eigen::MatrixXd>& rows, const Column& form) {
  const Candidate& candidate = candidates[static_cast<std::size_t>(form.owner)];
  const int variable = form.part % kFormCount, amplitude = form.part / kFormCount;
  std::size_t index;
  if (is_active(candidate, state, index)) return differencer.form(candidate, variable);
  const auto at = std::ranges::find_if(columns, [&](const Column& column) {
    return column.kind == Column::Kind::amplitude && column.owner == form.owner && column.part == amplitude;
  });
  return differencer.weighted(candidate.step[static_cast<std::size_t>(amplitude)] *
                                  rows[static_cast<std::size_t>(at - columns.begin())],
                              variable);
}

/// Charge drawn since the run's start, as a share of the run's greatest.
Eigen::VectorXd drawn_share(const Eigen::VectorXd& current_A) {
  Eigen::VectorXd drawn = current_A;
  for (Eigen::Index j = 1; j < drawn.size(); ++j) drawn[j] += drawn[j - 1];
  const double greatest = drawn.size() > 0 ? drawn.cwiseAbs().maxCoeff() : 0.0;
  return greatest > 0 ? Eigen::VectorXd(drawn / greatest) : drawn;
}

}  // namespace

AmplitudeStep amplitude_step(const ModelState& state, const Candidate& candidate, std::size_t part) {
  AmplitudeStep step{.value = std::vector<double>(candidate.amplitude.size(), 0.0)};
  std::size_t index;
  if (is_active(candidate, state, index)) step.value = state.effects[index].amplitude;
  step.high = candidate.step[part] * 0.5;
  step.low = candidate.nonnegative && step.value[part] < step.high ? 0.0 : -step.high;
  return step;
}

ModelState with_change(const ModelState& state, const Candidate& candidate, const AmplitudeStep& step,
                       std::size_t part, double change) {
  std::vector<double> moved = step.value;
  moved[part] += change;
  return with_effect(state, candidate, moved);
}

std::vector<Column> list_columns(const std::vector<Nuisance>& nuisances, const ModelState& state,
                                 const std::vector<Candidate>& candidates, std::size_t dictionary_entries,
                                 Forms forms) {
  std::vector<Column> columns;
  using Kind = Column::Kind;
  for (std::size_t k = 0; k < nuisances.size(); ++k)
    columns.push_back(
        {Kind::nuisance, static_cast<int>(k), 0, nuisances[k].sigma, state.nuisance_fraction[k]});
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    std::size_t index;
    const bool active = is_active(candidates[c], state, index);
    for (std::size_t a = 0; a < candidates[c].amplitude.size(); ++a)
      columns.push_back({Kind::amplitude, static_cast<int>(c), static_cast<int>(a),
                         kAmplitudePriorSteps * candidates[c].step[a],
                         active ? state.effects[index].amplitude[a] : 0.0});
    if (!active) continue;
    const std::vector<std::string> shapes = shape_parameters(candidates[c].shape.name);
    for (std::size_t s = 0; s < shapes.size(); ++s)
      columns.push_back({Kind::shape, static_cast<int>(c), static_cast<int>(s),
                         shape_prior_sd(candidates[c], shapes[s]), 0.0});
  }
  for (std::size_t c = 0; forms != Forms::none && c < candidates.size(); ++c) {
    std::size_t index;
    const bool active = is_active(candidates[c], state, index);
    if (!active && forms != Forms::all) continue;
    const int parts = active ? 1 : static_cast<int>(candidates[c].amplitude.size());
    for (int f = 0; f < parts * kFormCount; ++f)
      columns.push_back({Kind::form, static_cast<int>(c), f, kFormSpread, 0.0});
  }
  for (std::size_t d = 0; d < dictionary_entries; ++d)
    columns.push_back({Kind::dictionary, static_cast<int>(d), 0, 0.0, 0.0});
  return columns;
}

std::vector<Eigen::MatrixXd> signatures(const RunSignals& signals, const Robot& robot,
                                        const std::vector<Nuisance>& nuisances, const ModelState& state,
                                        const std::vector<Candidate>& candidates,
                                        const std::vector<Column>& columns, const Prediction& base) {
  const Differencer differencer(signals, robot, nuisances, state, base);
  std::vector<Eigen::MatrixXd> result;
  for (const Column& column : columns) {
    const auto owner = static_cast<std::size_t>(column.owner), part = static_cast<std::size_t>(column.part);
    if (column.kind == Column::Kind::nuisance)
      result.push_back(differencer.nuisance(owner, nuisances[owner].sigma));
    if (column.kind == Column::Kind::amplitude)
      result.push_back(differencer.amplitude(candidates[owner], part));
    if (column.kind == Column::Kind::form)
      result.push_back(form_rows(differencer, state, candidates, columns, result, column));
    if (column.kind == Column::Kind::shape)
      result.push_back(
          differencer.shape(candidates[owner], shape_parameters(candidates[owner].shape.name)[part]));
  }
  return result;
}

std::vector<Eigen::MatrixXd> run_signatures(const RunSignals& signals, const Robot& robot,
                                            const Prediction& base) {
  const Eigen::Index n = signals.size();
  std::vector<Eigen::MatrixXd> own(8, Eigen::MatrixXd::Zero(n, kChannelCount));
  for (Side side : kSides) {
    const std::size_t s = side == Side::left ? 0 : 1;
    const Motor& motor = robot.motor[side];
    for (Eigen::Index j = 0; j < n; ++j) {
      const double direction = signals.direction(side, j);
      own[s](j, kCurrentLeft + static_cast<int>(s)) = direction / motor.torque_per_ampere_Nm_A();
      own[2 + s](j, kWindingLeft + static_cast<int>(s)) = base.current_A[side][j];
      if (signals.motor_current_A[side].size() != n)
        own[s](j, kWindingLeft + static_cast<int>(s)) =
            motor.resistance_ohm * direction / motor.torque_per_ampere_Nm_A();
    }
  }
  own[4].col(kGyro).setConstant(1.0);
  own[5].col(kDriverPower).setConstant(1.0);
  own[6].col(kSupplyVoltage).setConstant(1.0);
  if (signals.battery_current_A.size() == n)
    own[7].col(kSupplyVoltage) = drawn_share(signals.battery_current_A);
  return own;
}

Eigen::MatrixXd payload_signature(const RunSignals& signals, const ModelPoint& point,
                                  const Prediction& base) {
  constexpr double kStep_kg = 1.0;
  if (signals.payload_known) return Eigen::MatrixXd::Zero(signals.size(), kChannelCount);
  RunSignals heavier = signals;
  heavier.payload_kg.array() += kStep_kg;
  return signature_rows(signals, point, base, predict(heavier, point)) / kStep_kg;
}

double payload_prior_sd_kg(const Robot& robot) {
  const double limit_kg = payload_limit_kg(robot);
  return std::isfinite(limit_kg) ? limit_kg : kUnstatedPayloadShare * robot.total_mass_kg(0.0);
}

Eigen::VectorXd run_start_variance(const Robot& robot) {
  const double open_V = robot.battery.open_circuit_voltage_V,
               charge_V = std::isfinite(open_V) ? kOpenCircuitChange * open_V : 0.0;
  Eigen::VectorXd sd(8);
  const double torque = kRunChange * (robot.motor.left.friction_torque_Nm + kLeastChangingFriction_Nm),
               ohm = kRunChange * robot.motor.left.resistance_ohm;
  sd << torque, torque, ohm, ohm, kRunGyroBias_rad_s, kRunStandby_W, charge_V, charge_V;
  return sd.cwiseAbs2();
}

}  // namespace joulepath
