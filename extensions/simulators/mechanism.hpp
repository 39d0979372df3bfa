#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace joulepath {

/// A rigid body with all joints at zero, in the frame of the model.
struct MechanismLink {
  std::string name{};
  std::string place{};    ///< "waffle.urdf line 12"
  std::size_t element{};  ///< of the file (XmlElement::index())
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};
  bool has_mass{};
  double mass_kg{};
  Eigen::Vector3d center_m{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d inertia_kg_m2{Eigen::Matrix3d::Zero()};  ///< about its center of mass
  std::vector<Eigen::Vector3d> outline_m{};                ///< points that span the collision shapes
  bool has_mesh{};                                         ///< a collision shape that is not read
  std::optional<double> radius_m{};                        ///< of a collision cylinder or sphere
  Eigen::Vector3d shape_center_m{Eigen::Vector3d::Zero()};
};

struct MechanismJoint {
  std::string name{};
  std::string place{};
  std::size_t element{};
  std::string parent{}, child{};
  bool turns{};  ///< a hinge; others hold the child, as far as a robot file is concerned
  bool fixed{};
  Eigen::Vector3d place_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d axis{Eigen::Vector3d::UnitZ()};
  double damping_Nm_s_rad{}, friction_Nm{}, rotor_inertia_kg_m2{};
  std::optional<double> speed_rad_s{};
  bool is_driven{};  ///< by a transmission, a command interface or an actuator
};

/// A length that a drive plugin states.
struct StatedLength {
  double value_m{};
  std::string place{};
};

/// What URDF, SDF and MJCF say about a robot.
struct Mechanism {
  std::string file{};
  std::string name{};
  std::vector<MechanismLink> links{};
  std::vector<MechanismJoint> joints{};
  std::vector<std::string> left{}, right{};  ///< joints that a differential drive plugin names
  std::optional<StatedLength> wheel_radius{}, separation{};
  std::vector<std::pair<std::string, StatedLength>> limits{};  ///< keys of `limits:` that the plugin states
  std::vector<std::string> notes{};
};

/// The points of shapes, in the frame of the shape.
[[nodiscard]] std::vector<Eigen::Vector3d> box_points(const Eigen::Vector3d& size_m);
[[nodiscard]] std::vector<Eigen::Vector3d> cylinder_points(double radius_m, double length_m);
[[nodiscard]] std::vector<Eigen::Vector3d> sphere_points(double radius_m);

/// Adds a collision shape to a link; a cylinder or a sphere gives the radius of a wheel.
void add_shape(MechanismLink& link, const Eigen::Isometry3d& pose,
               const std::vector<Eigen::Vector3d>& points_m, std::optional<double> radius_m = {});

/// A sphere, or the two ends of a capsule. Their outline is the same in every orientation.
void add_balls(MechanismLink& link, const Eigen::Isometry3d& pose,
               const std::vector<Eigen::Vector3d>& centers_m, double radius_m);

/// The centers of a capsule's ends; `length_m` is that of its cylinder.
[[nodiscard]] std::vector<Eigen::Vector3d> capsule_ends(double length_m);

/// Several bodies as one.
[[nodiscard]] MechanismLink combined(const std::vector<const MechanismLink*>& links);

}  // namespace joulepath
