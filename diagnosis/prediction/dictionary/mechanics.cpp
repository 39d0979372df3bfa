#include "diagnosis/prediction/dictionary/collector.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0505-unknown-terms.md
namespace joulepath {
namespace {

/// Variables of a sample. The pointers are null where only names are collected.
struct Variables {
  const DictionaryLayout& layout;
  const RunSignals* signals;
  const Robot* robot;

  BodyMotion<double> body(Eigen::Index j) const { return signals->rolled_motion(robot->geometry, j); }
  double day(Eigen::Index j) const { return day_share(layout, *signals, j); }
  double load(Eigen::Index j) const { return signals->payload_kg[j] / layout.greatest_payload_kg; }
  double speed(Eigen::Index j, Side side) const { return signals->wheel_speed_rad_s[side][j]; }
  double angle(Eigen::Index j, Side side) const { return signals->wheel_angle_rad[side][j]; }
  /// Harmonic of the heading: cosine (phase 0) or sine (phase 1).
  double heading_wave(int harmonic, int phase, Eigen::Index j) const {
    return phase ? std::sin(harmonic * signals->heading_rad[j])
                 : std::cos(harmonic * signals->heading_rad[j]);
  }
  /// Soft sign of the yaw rate.
  double turn(Eigen::Index j) const {
    return std::clamp(body(j).yaw_rate_rad_s / kBlurredTurn_rad_s, -1.0, 1.0);
  }
};

void add_speed_and_load(DictionaryCollector& out, const Variables& v) {
  constexpr int kSpeedHats = 6;
  const double speed_width = v.layout.greatest_wheel_speed_rad_s / (kSpeedHats - 1);
  for (int k = 0; k < kSpeedHats; ++k)
    out.friction("wheel speed", k == 0, [&](Eigen::Index j, Side side) {
      return hat(std::abs(v.speed(j, side)), k * speed_width, speed_width);
    });
  out.friction("direction", true,
               [&](Eigen::Index j, Side side) { return v.speed(j, side) < 0 ? 1.0 : 0.0; });
  out.friction("payload", false, [&](Eigen::Index j, Side) { return v.load(j); });
  out.friction("payload", false, [&](Eigen::Index j, Side) { return v.load(j) * v.load(j); });
  out.friction("payload", false, [&](Eigen::Index j, Side side) {
    return v.load(j) * v.speed(j, side) * (v.speed(j, side) > 0 ? 1 : -1);
  });
}

void add_wheel_angle_and_acceleration(DictionaryCollector& out, const Variables& v) {
  constexpr int kWheelHarmonics = 6;
  for (Side side : kSides)
    for (int h = 1; h <= kWheelHarmonics; ++h)
      for (int phase : {0, 1})
        out.torque("wheel angle", side, [&](Eigen::Index j) {
          const double angle = h * v.angle(j, side);
          return phase ? std::sin(angle) : std::cos(angle);
        });
  for (double length_rad : {2.0, 10.0})
    out.friction("distance since start", false, [&](Eigen::Index j, Side side) {
      return std::exp(-std::abs(v.angle(j, side)) / length_rad);
    });
  for (int k = 1; k <= 2; ++k)
    out.friction("wheel acceleration", false, [&](Eigen::Index j, Side side) {
      return std::pow(std::abs(v.signals->wheel_acceleration_rad_s2[side][j]), k);
    });
}

void add_time_of_day(DictionaryCollector& out, const Variables& v) {
  if (!v.layout.has_day) return;
  for (int k = 1; k <= 3; ++k)
    out.friction("time of day", k == 1, [&](Eigen::Index j, Side) { return std::pow(v.day(j), k); });
  for (int phase : {0, 1})
    out.force("time of day and heading",
              [&](Eigen::Index j) { return v.day(j) * v.heading_wave(1, phase, j); });
}

void add_heading(DictionaryCollector& out, const Variables& v) {
  for (int h : {1, 2})
    for (int phase : {0, 1}) {
      out.force("heading", [&](Eigen::Index j) { return v.heading_wave(h, phase, j); });
      out.friction("heading", false, [&](Eigen::Index j, Side) { return v.heading_wave(h, phase, j); });
    }
}

void add_forces(DictionaryCollector& out, const Variables& v) {
  const auto speed = [&](Eigen::Index j) { return v.body(j).speed_m_s; };
  const auto acceleration = [&](Eigen::Index j) { return v.body(j).acceleration_m_s2; };
  out.force("speed", speed);
  out.force("speed", [&](Eigen::Index j) { return speed(j) * std::abs(speed(j)); });
  out.force("acceleration", acceleration);
  out.force("acceleration", [&](Eigen::Index j) { return acceleration(j) * std::abs(acceleration(j)); });
  out.force("acceleration", [&](Eigen::Index j) { return acceleration(j) * v.load(j); });
  out.force("yaw rate", [&](Eigen::Index j) { return v.body(j).yaw_rate_rad_s * v.body(j).yaw_rate_rad_s; });
}

/// What the load still feels of earlier accelerations: it swings, slides or yields. The present one keeps it
/// from a false mass; the first fifth of a second is left out, where smoothed accelerations are inexact. A
/// log that begins in motion does not hold what the load still feels.
void add_past_acceleration(DictionaryCollector& out, const Variables& v) {
  constexpr int kLagHats = 11;
  constexpr double kLagWidth_s = 0.2;
  const bool from_rest = v.signals && std::abs(v.body(0).speed_m_s) <= kStandstillAlong_m_s;
  const auto load_acceleration = [&](Eigen::Index j, Eigen::Index at) {
    return from_rest ? v.load(j) * v.body(at).acceleration_m_s2 : 0.0;
  };
  out.force("past acceleration", [&](Eigen::Index j) { return load_acceleration(j, j); });
  for (int k = 1; k <= kLagHats; ++k)
    out.force("past acceleration", [&](Eigen::Index j) {
      const double period_s = v.signals->period_s, center_s = (k + 1) * kLagWidth_s;
      const auto last = std::min(j, static_cast<Eigen::Index>((center_s + kLagWidth_s) / period_s));
      double sum = 0;
      for (auto lag = static_cast<Eigen::Index>((center_s - kLagWidth_s) / period_s); lag <= last; ++lag)
        sum +=
            hat(static_cast<double>(lag) * period_s, center_s, kLagWidth_s) * load_acceleration(j, j - lag);
      return sum * period_s / kLagWidth_s;
    });
}

void add_moments(DictionaryCollector& out, const Variables& v) {
  constexpr int kYawHats = 4;
  const double yaw_width = v.layout.greatest_yaw_rate_rad_s / (kYawHats - 1);
  for (int k = 0; k < kYawHats; ++k)
    out.moment("yaw rate", [&](Eigen::Index j) {
      return v.turn(j) * hat(std::abs(v.body(j).yaw_rate_rad_s), k * yaw_width, yaw_width);
    });
  out.moment("yaw acceleration", [&](Eigen::Index j) { return v.body(j).yaw_acceleration_rad_s2; });
  out.moment("yaw rate", [&](Eigen::Index j) { return v.body(j).yaw_rate_rad_s * v.body(j).speed_m_s; });
  out.moment("yaw rate", [&](Eigen::Index j) { return v.turn(j) * v.load(j); });
}

void add_place(DictionaryCollector& out, const Variables& v) {
  if (!v.layout.has_place) return;
  constexpr int kPlaceHats = 6;
  const RunSignals* s = v.signals;
  const auto hats = [&](double least_m, double greatest_m, const auto& coordinate) {
    const double width = std::max(0.5, (greatest_m - least_m) / (kPlaceHats - 1));
    for (int k = 0; k < kPlaceHats; ++k)
      out.friction("place", false,
                   [&](Eigen::Index j, Side) { return hat(coordinate(j), least_m + k * width, width); });
  };
  hats(v.layout.x_min_m, v.layout.x_max_m, [&](Eigen::Index j) { return s->x_m[j]; });
  hats(v.layout.y_min_m, v.layout.y_max_m, [&](Eigen::Index j) { return s->y_m[j]; });
  const auto outward_m = [&](Eigen::Index j) {
    return s->x_m[j] * std::cos(s->heading_rad[j]) + s->y_m[j] * std::sin(s->heading_rad[j]);
  };
  out.force("place", outward_m);
  out.force("place",
            [&](Eigen::Index j) { return outward_m(j) / std::max(0.3, std::hypot(s->x_m[j], s->y_m[j])); });
}

}  // namespace

void add_mechanics(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                   const Robot* robot) {
  const Variables v{layout, s, robot};
  add_speed_and_load(out, v);
  add_wheel_angle_and_acceleration(out, v);
  add_time_of_day(out, v);
  add_heading(out, v);
  add_forces(out, v);
  add_past_acceleration(out, v);
  add_moments(out, v);
  add_place(out, v);
}

}  // namespace joulepath
