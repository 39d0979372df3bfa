#pragma once

#include <array>
#include <functional>

#include "extensions/simulators/mechanism.hpp"
#include "extensions/simulators/xml_file.hpp"

namespace joulepath {

[[nodiscard]] Mechanism read_urdf(const XmlElement& root);
[[nodiscard]] Mechanism read_sdf(const XmlElement& root);
[[nodiscard]] Mechanism read_mjcf(const XmlElement& root);

/// By its root element. Throws ConfigError for other XML files.
[[nodiscard]] Mechanism read_mechanism(const XmlElement& root);

/// Turns by roll, pitch and yaw, as URDF and SDF mean them.
[[nodiscard]] Eigen::Isometry3d placed(const Eigen::Vector3d& at_m, const Eigen::Vector3d& rpy_rad);

/// The tensor of the moments xx, yy, zz, xy, xz and yz, all read before: an exception within Eigen's `<<`
/// aborts.
[[nodiscard]] Eigen::Matrix3d inertia_of(const std::array<double, 6>& moments_kg_m2);

/// Adds a box, cylinder, capsule or sphere of URDF or SDF; other shapes are meshes. `sizes` reads so many
/// numbers of a name.
void add_primitive(MechanismLink& link, const Eigen::Isometry3d& pose, const XmlElement& shape,
                   const std::function<std::vector<double>(const char* name, std::size_t count)>& sizes);

/// A joint's speed limit; 0 and huge numbers stand for none.
[[nodiscard]] std::optional<double> stated_speed_rad_s(const std::optional<double>& limit);

/// What the plugins of a differential drive state, in Gazebo's old and new names.
void read_drive_plugins(const XmlElement& root, Mechanism& mechanism);

}  // namespace joulepath
