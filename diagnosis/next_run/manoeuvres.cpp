#include "diagnosis/next_run/manoeuvres.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/thresholds.hpp"

namespace joulepath {
namespace {

double usual_speed_m_s(const Robot& robot) {
  const double limit = robot.limits ? robot.limits->speed_m_s : kNoLimit;
  return std::isfinite(limit) ? 0.6 * limit : 0.5;
}

PrescribedMotion straight(double speed_m_s, double distance_m, double acceleration_m_s2, bool reverse) {
  PrescribedMotion motion{.profile = MotionProfile::trapezoid};
  motion.speed_m_s = speed_m_s;
  motion.distance_m = distance_m;
  motion.acceleration_m_s2 = acceleration_m_s2;
  motion.reverse = reverse;
  return motion;
}

PrescribedMotion spin(double angle_rad, double yaw_rate_rad_s) {
  PrescribedMotion motion{.profile = MotionProfile::spin};
  motion.angle_rad = angle_rad;
  motion.yaw_rate_rad_s = yaw_rate_rad_s;
  motion.yaw_acceleration_rad_s2 = 1.0;
  return motion;
}

PrescribedMotion arc(double radius_m, double angle_rad, double speed_m_s) {
  PrescribedMotion motion{.profile = MotionProfile::arc};
  motion.radius_m = radius_m;
  motion.angle_rad = angle_rad;
  motion.speed_m_s = speed_m_s;
  motion.acceleration_m_s2 = 0.25;
  return motion;
}

PrescribedMotion stand(double duration_s) {
  PrescribedMotion motion{.profile = MotionProfile::stand};
  motion.duration_s = duration_s;
  return motion;
}

void cap(std::optional<double>& value, double limit) {
  if (value) value = std::min(*value, limit);
}

void scale(std::optional<double>& value, double factor) {
  if (value) *value *= factor;
}

Manoeuvre with_load(Manoeuvre manoeuvre, double load) {
  manoeuvre.loads.assign(manoeuvre.motions.size(), load);
  return manoeuvre;
}

/// The manoeuvre empty, and once more with the greatest payload, which it takes on at a standstill.
Manoeuvre loaded_between(const Manoeuvre& manoeuvre) {
  Manoeuvre both = with_load(manoeuvre, 0.0);
  both.motions.push_back(stand(kLoading_s));
  both.loads.push_back(1.0);
  for (const PrescribedMotion& motion : manoeuvre.motions) {
    both.motions.push_back(motion);
    both.loads.push_back(1.0);
  }
  return both;
}

/// Whether no motion goes against another one's direction.
bool goes_one_way(const std::vector<PrescribedMotion>& motions) {
  bool forward = false, backward = false;
  for (const PrescribedMotion& motion : motions) {
    if (motion.profile == MotionProfile::stand) continue;
    (motion.reverse || motion.angle_rad.value_or(0.0) < 0 ? backward : forward) = true;
  }
  return !(forward && backward);
}

}  // namespace

std::vector<Manoeuvre> manoeuvre_library(const Robot& robot) {
  const double v = usual_speed_m_s(robot), pi = std::numbers::pi;
  std::vector<Manoeuvre> library{
      {"a standstill shows the power and the sensor readings without motion", {stand(20)}},
      {"the same lane in both directions separates losses that depend on the direction from others",
       {straight(v, 3, 0.25, false), stand(1), straight(v, 3, 0.25, true)}},
      {"spins in both directions show the resistance to turning without travel",
       {spin(2 * pi, 0.8), stand(1), spin(-2 * pi, 0.8)}},
      {"arcs in both directions show losses that grow with speed times yaw rate",
       {arc(0.8, pi, v), stand(1), arc(0.8, -pi, v)}},
      {"a crawl shows friction that decreases with speed",
       {straight(0.1 * v, 0.5, 0.25, false), stand(1), straight(0.25 * v, 1, 0.25, false)}},
      {"a fast run separates losses that are linear in speed from losses that are quadratic",
       {straight(1.5 * v, 8, 0.4, false)}},
      {"hard starts and stops show effects of acceleration",
       {straight(v, 1.5, 0.5, false), straight(v, 1.5, 0.5, true), straight(v, 1.5, 0.5, false)}},
  };
  const std::vector<Manoeuvre> plain = std::move(library);
  library.clear();
  for (const double load : {0.0, 1.0})
    for (const Manoeuvre& manoeuvre : plain) library.push_back(with_load(manoeuvre, load));
  for (const Manoeuvre& manoeuvre : plain) library.push_back(loaded_between(manoeuvre));
  return library;
}

std::vector<Manoeuvre> variants_of(const Manoeuvre& manoeuvre) {
  std::vector<Manoeuvre> variants;
  const auto add = [&](auto&& change) {
    variants.push_back(manoeuvre);
    for (PrescribedMotion& motion : variants.back().motions) change(motion);
  };
  for (double factor : {0.5, 1.5})
    add([&](PrescribedMotion& motion) {
      scale(motion.speed_m_s, factor), scale(motion.yaw_rate_rad_s, factor);
    });
  add([](PrescribedMotion& motion) {
    scale(motion.distance_m, 2), scale(motion.angle_rad, 2);
    if (motion.profile == MotionProfile::stand && motion.duration_s > 1)
      motion.duration_s = std::min(2 * *motion.duration_s, kLongestStand_s);
  });
  if (goes_one_way(manoeuvre.motions))
    add([](PrescribedMotion& motion) {
      if (motion.profile == MotionProfile::trapezoid) motion.reverse = !motion.reverse;
      scale(motion.angle_rad, -1);
    });
  const bool one_load =
      std::ranges::count(manoeuvre.loads, manoeuvre.loads.front()) == std::ssize(manoeuvre.loads);
  for (double load : {0.0, 0.5, 1.0})
    if (one_load && load != manoeuvre.loads.front()) variants.push_back(with_load(manoeuvre, load));
  return variants;
}

PrescribedMotion within(const Limits& limits, PrescribedMotion motion) {
  cap(motion.speed_m_s, limits.speed_m_s);
  cap(motion.acceleration_m_s2, std::min(limits.acceleration_m_s2, limits.deceleration_m_s2));
  cap(motion.yaw_rate_rad_s, limits.yaw_rate_rad_s);
  cap(motion.yaw_acceleration_rad_s2, limits.yaw_acceleration_rad_s2);
  if (!motion.radius_m) return motion;
  cap(motion.speed_m_s, std::min(limits.yaw_rate_rad_s * *motion.radius_m,
                                 std::sqrt(limits.lateral_acceleration_m_s2 * *motion.radius_m)));
  cap(motion.acceleration_m_s2, limits.yaw_acceleration_rad_s2 * *motion.radius_m);
  return motion;
}

}  // namespace joulepath
