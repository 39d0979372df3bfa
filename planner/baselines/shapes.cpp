#include "planner/baselines/shapes.hpp"

#include <cmath>

namespace joulepath {

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

Profile shaped_profile(const std::function<double(double)>& acceleration, double length, double duration_s) {
  constexpr int kPieces = 400;
  constexpr double kShare = 1.0 / kPieces;
  std::vector<JerkPiece> pieces;
  for (int i = 0; i < kPieces; ++i) {
    const double change = acceleration((i + 1) * kShare) - acceleration(i * kShare);
    pieces.push_back({kShare, change / kShare});
  }
  Profile profile = jerk_profile(pieces, acceleration(0));
  // Sampling changes the unit distance by about 1e-5; the profile is scaled to the exact length.
  const double scale = length / profile.s.back();
  for (double& t : profile.time_s) t *= duration_s;
  for (double& s : profile.s) s *= scale;
  for (double& u : profile.rate) u *= scale / duration_s;
  for (double& a : profile.acceleration) a *= scale / (duration_s * duration_s);
  for (double& j : profile.jerk) j *= scale / (duration_s * duration_s * duration_s);
  profile.s.back() = length;
  profile.rate.back() = 0;
  return profile;
}

}  // namespace joulepath
