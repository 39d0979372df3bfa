#include <algorithm>
#include <cmath>

#include "diagnosis/prediction/dictionary.hpp"

namespace joulepath {

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
      grow(layout.greatest_yaw_rate_rad_s, std::abs(run.rolled_motion(robot.geometry, j).yaw_rate_rad_s));
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

}  // namespace joulepath
