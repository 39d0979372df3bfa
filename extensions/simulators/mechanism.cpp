#include "extensions/simulators/mechanism.hpp"

#include <cmath>
#include <numbers>

namespace joulepath {
namespace {

constexpr int kRoundCorners = 16;  ///< of a circle in a footprint

}  // namespace

std::vector<Eigen::Vector3d> box_points(const Eigen::Vector3d& size_m) {
  std::vector<Eigen::Vector3d> points;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5}) points.push_back(Eigen::Vector3d(x, y, z).cwiseProduct(size_m));
  return points;
}

std::vector<Eigen::Vector3d> cylinder_points(double radius_m, double length_m) {
  // Circumscribed, so that no part of the circle is outside.
  const double corner_m = radius_m / std::cos(std::numbers::pi / kRoundCorners);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < kRoundCorners; ++i)
    for (const double z : {-0.5, 0.5}) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kRoundCorners;
      points.emplace_back(corner_m * std::cos(angle), corner_m * std::sin(angle), z * length_m);
    }
  return points;
}

std::vector<Eigen::Vector3d> sphere_points(double radius_m) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& point : cylinder_points(radius_m, 0)) {
    points.push_back(point);
    points.emplace_back(point.y(), point.z(), point.x());
    points.emplace_back(point.z(), point.x(), point.y());
  }
  return points;
}

void add_shape(MechanismLink& link, const Eigen::Isometry3d& pose,
               const std::vector<Eigen::Vector3d>& points_m, std::optional<double> radius_m) {
  for (const Eigen::Vector3d& point : points_m) link.outline_m.push_back(pose * point);
  if (!radius_m || link.radius_m) return;
  link.radius_m = radius_m;
  link.shape_center_m = pose.translation();
}

void add_balls(MechanismLink& link, const Eigen::Isometry3d& pose,
               const std::vector<Eigen::Vector3d>& centers_m, double radius_m) {
  for (const Eigen::Vector3d& center : centers_m)
    for (const Eigen::Vector3d& point : sphere_points(radius_m))
      link.outline_m.push_back(pose * center + point);
  add_shape(link, pose, {}, radius_m);
}

std::vector<Eigen::Vector3d> capsule_ends(double length_m) {
  return {Eigen::Vector3d(0, 0, -0.5 * length_m), Eigen::Vector3d(0, 0, 0.5 * length_m)};
}

MechanismLink combined(const std::vector<const MechanismLink*>& links) {
  MechanismLink sum;
  for (const MechanismLink* link : links) {
    sum.mass_kg += link->mass_kg;
    sum.center_m += link->mass_kg * link->center_m;
  }
  if (sum.mass_kg > 0) sum.center_m /= sum.mass_kg;
  for (const MechanismLink* link : links) {
    const Eigen::Vector3d d = link->center_m - sum.center_m;
    sum.inertia_kg_m2 += link->inertia_kg_m2 +
                         link->mass_kg * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  }
  return sum;
}

}  // namespace joulepath
