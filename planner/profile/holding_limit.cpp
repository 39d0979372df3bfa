#include "planner/profile/holding_limit.hpp"

#include <algorithm>
#include <cstdio>

#include "planner/motion/limit_check.hpp"

namespace joulepath {
namespace {

constexpr double kHolds =
    0.99;  ///< of a limit: the fastest drive uses at least this much of a limit that holds it

}  // namespace

void HoldingLimits::add(const ProfileRequest& request, const Profile& fastest, double offset_m) {
  const PathMotion motion = path_motion(request);
  for (std::size_t k = 0; k + 1 < fastest.s.size(); ++k) {
    const double dt = fastest.time_s[k + 1] - fastest.time_s[k];
    const ProfileState state = fastest.at_time(fastest.time_s[k] + 0.5 * dt);
    std::string_view name;
    double most = kHolds;
    for_each_limit_use(motion, request.limits, request.speed_caps, state, fastest.jerk[k],
                       [&](std::string_view limit, double ratio) {
                         if (ratio > most) most = ratio, name = limit;
                       });
    time_s_ += dt;
    if (name.empty()) continue;
    const bool turn = is_turn(request.piece);
    const auto [hold, fresh] =
        holds_.try_emplace(std::string(name), Hold{0.0, offset_m + (turn ? 0.0 : state.s), turn});
    hold->second.time_s += dt;
  }
}

std::string HoldingLimits::sentence() const {
  if (holds_.empty()) return "";
  const auto longest = std::max_element(holds_.begin(), holds_.end(), [](const auto& a, const auto& b) {
    return a.second.time_s < b.second.time_s;
  });
  const auto& [name, hold] = *longest;
  char text[200];
  std::snprintf(text, sizeof text,
                "; %s limits the fastest drive for %.0f %% of its time, first %sat s = %.3g m", name.c_str(),
                100 * hold.time_s / time_s_, hold.turn ? "in the turn in place " : "", hold.first_s);
  return text;
}

}  // namespace joulepath
