#include "diagnosis/prediction/dictionary/collector.hpp"

namespace joulepath {

void add_supply(DictionaryCollector& out, const DictionaryLayout& layout, const RunSignals* s,
                const Prediction* p) {
  const auto day = [&](Eigen::Index j) { return day_share(layout, *s, j); };
  const auto sum = [&](const Sided<Eigen::VectorXd>& of, Eigen::Index j) { return of.left[j] + of.right[j]; };
  const auto drawn_A = [&](Eigen::Index j) {
    return s->battery_current_A.size() > 0 ? s->battery_current_A[j] : 0.0;
  };
  out.battery_power("constant", [](Eigen::Index) { return 1.0; });
  out.battery_power("motor power", [&](Eigen::Index j) { return std::max(0.0, sum(p->power_W, j)); });
  out.battery_power("motor power", [&](Eigen::Index j) { return std::min(0.0, sum(p->power_W, j)); });
  out.battery_power("current", [&](Eigen::Index j) {
    return std::abs(p->current_A.left[j]) + std::abs(p->current_A.right[j]);
  });
  out.battery_power("current", [&](Eigen::Index j) {
    return std::pow(p->current_A.left[j], 2) + std::pow(p->current_A.right[j], 2);
  });
  out.battery_power("wheel speed", [&](Eigen::Index j) {
    return std::abs(s->wheel_speed_rad_s.left[j]) + std::abs(s->wheel_speed_rad_s.right[j]);
  });
  out.battery_voltage("constant", [](Eigen::Index) { return 1.0; });
  out.battery_voltage("current", drawn_A);
  out.battery_voltage("current", [&](Eigen::Index j) { return drawn_A(j) * std::abs(drawn_A(j)); });
  if (!layout.has_day) return;
  for (int k = 1; k <= 2; ++k) {
    out.battery_power("time of day", [&, k](Eigen::Index j) { return std::pow(day(j), k); });
    out.battery_voltage("time of day", [&, k](Eigen::Index j) { return std::pow(day(j), k); });
  }
}

}  // namespace joulepath
