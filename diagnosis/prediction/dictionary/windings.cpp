#include "diagnosis/prediction/dictionary/collector.hpp"
#include "diagnosis/thresholds.hpp"
// Design: docs/decisions/0505-unknown-terms.md

namespace joulepath {

void add_motors(DictionaryCollector& out, const Robot* robot, const Prediction* p) {
  const auto current_A = [&](Eigen::Index j, Side side) { return p->current_A[side][j]; };
  out.friction("motor torque", false, [&](Eigen::Index j, Side side) {
    return robot->motor[side].torque_per_ampere_Nm_A() * std::abs(current_A(j, side));
  });
  out.known_as("loss by torque");
  for (Side one : kSides) {
    out.reading("constant", p, [one](Eigen::Index, Side side) { return side == one ? 1.0 : 0.0; });
    out.known_as("shifted reading");
  }
  out.reading("current", p, current_A);
  out.known_as("scaled reading");
  out.reading("current", p, [&](Eigen::Index j, Side side) { return side_sign(side) * current_A(j, side); });
}

void add_windings(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                  const Prediction* p) {
  const auto current = [&](Eigen::Index j, Side side) { return p->current_A[side][j]; };
  out.voltage("constant", true, [&](Eigen::Index, Side) { return 1.0; });
  out.voltage("current", true, current);
  out.voltage("current", false,
              [&](Eigen::Index j, Side side) { return current(j, side) * std::abs(current(j, side)); });
  out.voltage("current", false, [&](Eigen::Index j, Side side) { return std::pow(current(j, side), 3); });
  out.voltage("current", false,
              [&](Eigen::Index j, Side side) { return s->current_sign(side, j, current(j, side)); });
  out.known_as("drop by sign");
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
    const auto day = [&, k](Eigen::Index j) { return std::pow(day_share(layout, *s, j), k); };
    out.voltage("time of day", k == 1, [&](Eigen::Index j, Side side) { return day(j) * current(j, side); });
    out.voltage("time of day", k == 1,
                [&](Eigen::Index j, Side side) { return day(j) * s->wheel_speed_rad_s[side][j]; });
  }
}

}  // namespace joulepath
