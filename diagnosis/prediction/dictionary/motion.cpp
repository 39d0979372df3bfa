#include "diagnosis/prediction/dictionary/collector.hpp"

namespace joulepath {

void add_motion(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                const Robot* robot) {
  const auto body = [&](Eigen::Index j) { return s->rolled_motion(robot->geometry, j); };
  const auto none = [](Eigen::Index) { return 0.0; };
  const auto speed = [&](Eigen::Index j) { return body(j).speed_m_s; };
  const auto yaw = [&](Eigen::Index j) { return body(j).yaw_rate_rad_s; };
  out.motion("speed", speed, none);
  out.motion(
      "speed", [&](Eigen::Index j) { return speed(j) * std::abs(speed(j)); }, none);
  out.motion("speed", none, speed);
  out.motion("yaw rate", none, yaw);
  out.motion("yaw rate", none, [&](Eigen::Index j) { return yaw(j) * std::abs(yaw(j)); });
  out.motion(
      "acceleration", [&](Eigen::Index j) { return body(j).acceleration_m_s2; }, none);
  out.motion("acceleration", none, [&](Eigen::Index j) { return body(j).yaw_acceleration_rad_s2; });
  out.motion(
      "payload", [&](Eigen::Index j) { return speed(j) * s->payload_kg[j] / layout.greatest_payload_kg; },
      none);
  out.motion("payload", none,
             [&](Eigen::Index j) { return yaw(j) * s->payload_kg[j] / layout.greatest_payload_kg; });
  if (!layout.has_day) return;
  const auto day = [&](Eigen::Index j) { return day_share(layout, *s, j); };
  out.motion(
      "time of day", [&](Eigen::Index j) { return day(j) * speed(j); }, none);
  out.motion("time of day", none, [&](Eigen::Index j) { return day(j) * speed(j); });
  out.motion("time of day", none, [&](Eigen::Index j) { return day(j) * yaw(j); });
}

}  // namespace joulepath
