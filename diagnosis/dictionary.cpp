#include "diagnosis/dictionary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/kinematics.hpp"

namespace joulepath {
namespace {

/// A hat function: 1 at `center`, 0 a `width` away.
double hat(double x, double center, double width) {
  return std::max(0.0, 1.0 - std::abs(x - center) / width);
}

/// Collects entries; either only their names (no signals) or their rows too.
class Collector {
 public:
  Collector(const RunSignals* signals, const Robot* robot) : signals_(signals), robot_(robot) {}

  /// A resisting torque of both wheels alike (and the left less the right, where `apart`).
  template <class Function>
  void friction(const std::string& family, bool apart, Function&& size) {
    for (int sign : {1, -1}) {
      if (sign < 0 && !apart) break;
      entry(family, "current", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
        for (Side side : kSides) {
          const double speed = signals_->wheel_speed_rad_s[side][j];
          const double direction = std::clamp(speed / 0.2, -1.0, 1.0);
          const double torque_Nm = direction * size(j, side) * (side == Side::right ? sign : 1);
          entry_rows(j, column(kCurrentLeft, side)) =
              torque_Nm / robot_->motor[side].torque_per_ampere_Nm_A();
        }
      });
    }
  }
  /// A force along the heading.
  template <class Function>
  void force(const std::string& family, Function&& size_N) {
    entry(family, "current", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      for (Side side : kSides)
        entry_rows(j, column(kCurrentLeft, side)) = 0.5 * robot_->geometry.wheel_radius_m[side] * size_N(j) /
                                                    robot_->motor[side].torque_per_ampere_Nm_A();
    });
  }
  /// A yaw moment.
  template <class Function>
  void moment(const std::string& family, Function&& size_Nm) {
    entry(family, "current", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      for (Side side : kSides)
        entry_rows(j, column(kCurrentLeft, side)) = side_sign(side) * robot_->geometry.wheel_radius_m[side] /
                                                    (2 * robot_->geometry.half_track_m) * size_Nm(j) /
                                                    robot_->motor[side].torque_per_ampere_Nm_A();
    });
  }
  /// A voltage in the winding's equation.
  template <class Function>
  void voltage(const std::string& family, bool apart, Function&& size_V) {
    for (int sign : {1, -1}) {
      if (sign < 0 && !apart) break;
      entry(family, "voltage", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
        for (Side side : kSides)
          entry_rows(j, column(kWindingLeft, side)) = size_V(j, side) * (side == Side::right ? sign : 1);
      });
    }
  }
  /// Speed along the heading and yaw rate that the wheels do not show.
  template <class Along, class Yaw>
  void motion(const std::string& family, Along&& along_m_s, Yaw&& yaw_rad_s) {
    double x_m = 0, y_m = 0, heading_rad = 0;
    entry(family, "motion", [&](Eigen::Index j, Eigen::MatrixXd& entry_rows) {
      const double along = along_m_s(j), yaw = yaw_rad_s(j), period_s = signals_->period_s;
      x_m += along * std::cos(signals_->heading_rad[j]) * period_s;
      y_m += along * std::sin(signals_->heading_rad[j]) * period_s;
      heading_rad += yaw * period_s;
      entry_rows(j, kGyro) = yaw;
      entry_rows(j, kHeading) = heading_rad;
      entry_rows(j, kPositionX) = x_m;
      entry_rows(j, kPositionY) = y_m;
    });
  }

  std::vector<DictionaryEntry> entries{};
  std::vector<Eigen::MatrixXd> rows{};

 private:
  static Eigen::Index column(Channel left, Side side) { return left + (side == Side::left ? 0 : 1); }

  template <class Function>
  void entry(const std::string& family, const std::string& channel, Function&& fill) {
    entries.push_back({family, channel});
    if (!signals_) return;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(signals_->size(), kChannelCount);
    for (Eigen::Index j = 0; j < signals_->size(); ++j) fill(j, matrix);
    for (Channel pose : {kHeading, kPositionX, kPositionY}) {
      const double mean = matrix.rows() > 0 ? matrix.col(pose).mean() : 0.0;
      matrix.col(pose).array() -= mean;
    }
    rows.push_back(std::move(matrix));
  }

  const RunSignals* signals_;
  const Robot* robot_;
};

void add_mechanics(Collector& out, const DictionaryLayout& layout, const RunSignals* s, const Robot* robot) {
  const auto twist = [&](Eigen::Index j) {
    return body_twist(robot->geometry,
                      Sided<double>{s->wheel_speed_rad_s.left[j], s->wheel_speed_rad_s.right[j]});
  };
  const auto rate = [&](Eigen::Index j) {
    return body_twist(robot->geometry, Sided<double>{s->wheel_acceleration_rad_s2.left[j],
                                                     s->wheel_acceleration_rad_s2.right[j]});
  };
  const double day_s = std::max(1.0, layout.day_end_s - layout.day_begin_s);
  const auto day = [&](Eigen::Index j) { return (s->time_of_day_s[j] - layout.day_begin_s) / day_s; };
  const auto load = [&](Eigen::Index j) { return s->payload_kg[j] / layout.greatest_payload_kg; };

  constexpr int kSpeedHats = 6;
  const double speed_width = layout.greatest_wheel_speed_rad_s / (kSpeedHats - 1);
  for (int k = 0; k < kSpeedHats; ++k)
    out.friction("wheel speed", k == 0, [&](Eigen::Index j, Side side) {
      return hat(std::abs(s->wheel_speed_rad_s[side][j]), k * speed_width, speed_width);
    });
  out.friction("direction", true,
               [&](Eigen::Index j, Side side) { return s->wheel_speed_rad_s[side][j] < 0 ? 1.0 : 0.0; });
  out.friction("payload", false, [&](Eigen::Index j, Side) { return load(j); });
  out.friction("payload", false, [&](Eigen::Index j, Side) { return load(j) * load(j); });
  out.friction("payload", false, [&](Eigen::Index j, Side side) {
    return load(j) * s->wheel_speed_rad_s[side][j] * (s->wheel_speed_rad_s[side][j] > 0 ? 1 : -1);
  });
  for (int h : {1, 2})
    for (int phase : {0, 1})
      out.friction("wheel angle", true, [&](Eigen::Index j, Side side) {
        const double angle = h * s->wheel_angle_rad[side][j];
        return phase ? std::sin(angle) : std::cos(angle);
      });
  out.friction("distance since start", false, [&](Eigen::Index j, Side side) {
    return std::exp(-std::abs(s->wheel_angle_rad[side][j]) / 2.0);
  });
  out.friction("distance since start", false, [&](Eigen::Index j, Side side) {
    return std::exp(-std::abs(s->wheel_angle_rad[side][j]) / 10.0);
  });
  for (int k = 1; k <= 2; ++k)
    out.friction("wheel acceleration", false, [&](Eigen::Index j, Side side) {
      const double i = std::abs(s->wheel_acceleration_rad_s2[side][j]);
      return std::pow(i, k);
    });
  if (layout.has_day) {
    for (int k = 1; k <= 3; ++k)
      out.friction("time of day", k == 1, [&](Eigen::Index j, Side) { return std::pow(day(j), k); });
    for (int phase : {0, 1})
      out.force("time of day and heading", [&](Eigen::Index j) {
        return day(j) * (phase ? std::sin(s->heading_rad[j]) : std::cos(s->heading_rad[j]));
      });
  }
  for (int h : {1, 2})
    for (int phase : {0, 1}) {
      const auto wave = [&](Eigen::Index j) {
        return phase ? std::sin(h * s->heading_rad[j]) : std::cos(h * s->heading_rad[j]);
      };
      out.force("heading", [&](Eigen::Index j) { return wave(j); });
      out.friction("heading", false, [&](Eigen::Index j, Side) { return wave(j); });
    }
  out.force("speed", [&](Eigen::Index j) { return twist(j).speed_m_s; });
  out.force("speed", [&](Eigen::Index j) { return twist(j).speed_m_s * std::abs(twist(j).speed_m_s); });
  out.force("acceleration", [&](Eigen::Index j) { return rate(j).speed_m_s; });
  out.force("acceleration", [&](Eigen::Index j) { return rate(j).speed_m_s * std::abs(rate(j).speed_m_s); });
  out.force("acceleration", [&](Eigen::Index j) { return rate(j).speed_m_s * load(j); });
  out.force("yaw rate", [&](Eigen::Index j) { return twist(j).yaw_rate_rad_s * twist(j).yaw_rate_rad_s; });
  constexpr int kYawHats = 4;
  const double yaw_width = layout.greatest_yaw_rate_rad_s / (kYawHats - 1);
  for (int k = 0; k < kYawHats; ++k)
    out.moment("yaw rate", [&](Eigen::Index j) {
      const double omega = twist(j).yaw_rate_rad_s;
      return std::clamp(omega / 0.04, -1.0, 1.0) * hat(std::abs(omega), k * yaw_width, yaw_width);
    });
  out.moment("yaw acceleration", [&](Eigen::Index j) { return rate(j).yaw_rate_rad_s; });
  out.moment("yaw rate", [&](Eigen::Index j) { return twist(j).yaw_rate_rad_s * twist(j).speed_m_s; });
  out.moment("yaw rate",
             [&](Eigen::Index j) { return std::clamp(twist(j).yaw_rate_rad_s / 0.04, -1.0, 1.0) * load(j); });
  if (layout.has_place) {
    constexpr int kPlaceHats = 6;
    const auto place = [&](double least_m, double greatest_m, const auto& coordinate) {
      const double width = std::max(0.5, (greatest_m - least_m) / (kPlaceHats - 1));
      for (int k = 0; k < kPlaceHats; ++k)
        out.friction("place", false,
                     [&](Eigen::Index j, Side) { return hat(coordinate(j), least_m + k * width, width); });
    };
    place(layout.x_min_m, layout.x_max_m, [&](Eigen::Index j) { return s->x_m[j]; });
    place(layout.y_min_m, layout.y_max_m, [&](Eigen::Index j) { return s->y_m[j]; });
    out.force("place", [&](Eigen::Index j) {
      return s->x_m[j] * std::cos(s->heading_rad[j]) + s->y_m[j] * std::sin(s->heading_rad[j]);
    });
    out.force("place", [&](Eigen::Index j) {
      return (s->x_m[j] * std::cos(s->heading_rad[j]) + s->y_m[j] * std::sin(s->heading_rad[j])) /
             std::max(0.3, std::hypot(s->x_m[j], s->y_m[j]));
    });
  }
}

void add_windings(Collector& out, const DictionaryLayout& layout, const RunSignals* s, const Prediction* p) {
  const auto current = [&](Eigen::Index j, Side side) { return p->current_A[side][j]; };
  const double day_s = std::max(1.0, layout.day_end_s - layout.day_begin_s);
  out.voltage("constant", true, [&](Eigen::Index, Side) { return 1.0; });
  out.voltage("current", true, current);
  out.voltage("current", false,
              [&](Eigen::Index j, Side side) { return current(j, side) * std::abs(current(j, side)); });
  out.voltage("current", false, [&](Eigen::Index j, Side side) { return std::pow(current(j, side), 3); });
  out.voltage("current", false,
              [&](Eigen::Index j, Side side) { return std::clamp(current(j, side) / 0.03, -1.0, 1.0); });
  for (double corner : {0.4, 0.6, 0.8})
    out.voltage("current", false, [&, corner](Eigen::Index j, Side side) {
      const double i = current(j, side), beyond = std::abs(i) - corner * layout.greatest_current_A;
      return beyond > 0 ? std::copysign(beyond, i) : 0.0;
    });
  out.voltage("wheel speed", true, [&](Eigen::Index j, Side side) { return s->wheel_speed_rad_s[side][j]; });
  out.voltage("wheel speed", false, [&](Eigen::Index j, Side side) {
    return s->wheel_speed_rad_s[side][j] * std::abs(s->wheel_speed_rad_s[side][j]);
  });
  out.voltage("acceleration", false,
              [&](Eigen::Index j, Side side) { return s->wheel_acceleration_rad_s2[side][j]; });
  if (!layout.has_day) return;
  for (int k = 1; k <= 2; ++k) {
    const auto day = [&, k](Eigen::Index j) {
      return std::pow((s->time_of_day_s[j] - layout.day_begin_s) / day_s, k);
    };
    out.voltage("time of day", k == 1, [&](Eigen::Index j, Side side) { return day(j) * current(j, side); });
    out.voltage("time of day", k == 1,
                [&](Eigen::Index j, Side side) { return day(j) * s->wheel_speed_rad_s[side][j]; });
  }
}

void add_motion(Collector& out, const DictionaryLayout& layout, const RunSignals* s, const Robot* robot) {
  const auto twist = [&](Eigen::Index j) {
    return body_twist(robot->geometry,
                      Sided<double>{s->wheel_speed_rad_s.left[j], s->wheel_speed_rad_s.right[j]});
  };
  const auto rate = [&](Eigen::Index j) {
    return body_twist(robot->geometry, Sided<double>{s->wheel_acceleration_rad_s2.left[j],
                                                     s->wheel_acceleration_rad_s2.right[j]});
  };
  const auto none = [](Eigen::Index) { return 0.0; };
  const double day_s = std::max(1.0, layout.day_end_s - layout.day_begin_s);
  const auto speed = [&](Eigen::Index j) { return twist(j).speed_m_s; };
  const auto yaw = [&](Eigen::Index j) { return twist(j).yaw_rate_rad_s; };
  out.motion("speed", speed, none);
  out.motion(
      "speed", [&](Eigen::Index j) { return speed(j) * std::abs(speed(j)); }, none);
  out.motion("speed", none, speed);
  out.motion("yaw rate", none, yaw);
  out.motion("yaw rate", none, [&](Eigen::Index j) { return yaw(j) * std::abs(yaw(j)); });
  out.motion(
      "acceleration", [&](Eigen::Index j) { return rate(j).speed_m_s; }, none);
  out.motion("acceleration", none, [&](Eigen::Index j) { return rate(j).yaw_rate_rad_s; });
  out.motion(
      "payload", [&](Eigen::Index j) { return speed(j) * s->payload_kg[j] / layout.greatest_payload_kg; },
      none);
  out.motion("payload", none,
             [&](Eigen::Index j) { return yaw(j) * s->payload_kg[j] / layout.greatest_payload_kg; });
  if (!layout.has_day) return;
  const auto day = [&](Eigen::Index j) { return (s->time_of_day_s[j] - layout.day_begin_s) / day_s; };
  out.motion(
      "time of day", [&](Eigen::Index j) { return day(j) * speed(j); }, none);
  out.motion("time of day", none, [&](Eigen::Index j) { return day(j) * speed(j); });
  out.motion("time of day", none, [&](Eigen::Index j) { return day(j) * yaw(j); });
}

}  // namespace

DictionaryLayout lay_out(const std::vector<RunSignals>& runs, const Robot& robot) {
  DictionaryLayout layout{.x_min_m = 1e300,
                          .x_max_m = -1e300,
                          .y_min_m = 1e300,
                          .y_max_m = -1e300,
                          .day_begin_s = 1e300,
                          .day_end_s = -1e300};
  layout.has_day = !runs.empty();
  const auto grow = [](double& value, double candidate) { value = std::max(value, candidate); };
  for (const RunSignals& run : runs) {
    if (run.size() == 0) continue;
    layout.has_day &= run.time_of_day_known;
    layout.day_begin_s = std::min(layout.day_begin_s, run.time_of_day_s[0]);
    grow(layout.day_end_s, run.time_of_day_s[run.size() - 1]);
    grow(layout.greatest_payload_kg, run.payload_kg.maxCoeff());
    for (Side side : kSides) {
      grow(layout.greatest_wheel_speed_rad_s, run.wheel_speed_rad_s[side].cwiseAbs().maxCoeff());
      if (run.motor_current_A[side].size() > 0)
        grow(layout.greatest_current_A, run.motor_current_A[side].cwiseAbs().maxCoeff());
    }
    for (Eigen::Index j = 0; j < run.size(); ++j)
      grow(layout.greatest_yaw_rate_rad_s,
           std::abs(body_twist(robot.geometry,
                               Sided<double>{run.wheel_speed_rad_s.left[j], run.wheel_speed_rad_s.right[j]})
                        .yaw_rate_rad_s));
    if (run.x_m.size() == 0) continue;
    layout.has_place = true;
    layout.x_min_m = std::min(layout.x_min_m, run.x_m.minCoeff());
    layout.y_min_m = std::min(layout.y_min_m, run.y_m.minCoeff());
    grow(layout.x_max_m, run.x_m.maxCoeff());
    grow(layout.y_max_m, run.y_m.maxCoeff());
  }
  for (const RunSignals& run : runs) layout.has_place &= run.x_m.size() > 0;
  return layout;
}

std::vector<DictionaryEntry> dictionary_entries(const DictionaryLayout& layout) {
  Collector collector(nullptr, nullptr);
  add_mechanics(collector, layout, nullptr, nullptr);
  add_windings(collector, layout, nullptr, nullptr);
  add_motion(collector, layout, nullptr, nullptr);
  return collector.entries;
}

std::vector<Eigen::MatrixXd> dictionary_rows(const DictionaryLayout& layout, const RunSignals& signals,
                                             const Robot& robot, const Prediction& prediction) {
  Collector collector(&signals, &robot);
  add_mechanics(collector, layout, &signals, &robot);
  add_windings(collector, layout, &signals, &prediction);
  add_motion(collector, layout, &signals, &robot);
  return collector.rows;
}

}  // namespace joulepath
