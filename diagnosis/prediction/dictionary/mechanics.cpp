#include "diagnosis/prediction/dictionary/collector.hpp"

namespace joulepath {

void add_mechanics(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                   const Robot* robot) {
  const auto twist = [&](Eigen::Index j) { return twist_at(*s, *robot, j); };
  const auto rate = [&](Eigen::Index j) { return twist_rate_at(*s, *robot, j); };
  const auto day = [&](Eigen::Index j) { return day_share(layout, *s, j); };
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
  constexpr int kWheelHarmonics = 6;
  for (Side side : kSides)
    for (int h = 1; h <= kWheelHarmonics; ++h)
      for (int phase : {0, 1})
        out.torque("wheel angle", side, [&](Eigen::Index j) {
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

}  // namespace joulepath
