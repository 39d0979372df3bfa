#include "planner/baselines/shapes.hpp"

#include <cmath>

namespace joulepath {

Profile shaped_profile(const TimeShape& shape, double length, double duration_s) {
  constexpr int kNodes = 400;
  std::vector<double> s, b;
  for (int i = 0; i <= kNodes; ++i) {
    const double share = static_cast<double>(i) / kNodes, rate = shape.rate(share) * length / duration_s;
    s.push_back(i == kNodes ? length : length * shape.distance_share(share));
    b.push_back(i == 0 || i == kNodes ? 0.0 : rate * rate);
  }
  const double taken_s = profile_from_squares(s, b).time_s.back();
  for (double& square : b) square *= (taken_s / duration_s) * (taken_s / duration_s);
  return profile_from_squares(s, b);
}

Profile jerk_profile(const std::vector<JerkPiece>& pieces, double start_acceleration) {
  Profile profile{.time_s = {0.0}, .s = {0.0}, .rate = {0.0}};
  double a = start_acceleration;
  for (const JerkPiece& piece : pieces) {
    const double t = piece.duration_s, j = piece.jerk, u = profile.rate.back();
    if (!(t > 0)) continue;
    profile.acceleration.push_back(a);
    profile.jerk.push_back(j);
    profile.time_s.push_back(profile.time_s.back() + t);
    profile.s.push_back(profile.s.back() + t * (u + t * (a / 2 + t * j / 6)));
    profile.rate.push_back(std::max(0.0, u + t * (a + t * j / 2)));
    a += t * j;
  }
  return profile;
}

}  // namespace joulepath
