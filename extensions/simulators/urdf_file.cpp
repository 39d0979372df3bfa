#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "extensions/simulators/model_files.hpp"
#include "scenarios/text/quoted.hpp"

namespace joulepath {
namespace {

Eigen::Isometry3d urdf_origin(const XmlElement& element) {
  const auto origin = element.find("origin");
  if (!origin) return Eigen::Isometry3d::Identity();
  return placed(origin->vector(origin->attribute("xyz").value_or("0 0 0")),
                origin->vector(origin->attribute("rpy").value_or("0 0 0")));
}

void add_urdf_mass(const XmlElement& element, MechanismLink& link) {
  const auto inertial = element.find("inertial");
  if (!inertial) return;
  const auto mass = inertial->find("mass"), inertia = inertial->find("inertia");
  if (!mass || !inertia) inertial->fail("no mass or no inertia", "<mass value=...> and <inertia ixx=...>");
  const Eigen::Isometry3d pose = link.pose * urdf_origin(*inertial);
  const auto moment = [&](const char* name) {
    return inertia->number(inertia->attribute(name).value_or("0"));
  };
  const Eigen::Matrix3d own =
      inertia_of({moment("ixx"), moment("iyy"), moment("izz"), moment("ixy"), moment("ixz"), moment("iyz")});
  link.has_mass = true;
  link.mass_kg = mass->number(mass->required("value"));
  link.center_m = pose.translation();
  link.inertia_kg_m2 = pose.rotation() * own * pose.rotation().transpose();
}

void add_urdf_shapes(const XmlElement& element, MechanismLink& link) {
  for (const XmlElement& collision : element.children("collision")) {
    const auto geometry = collision.find("geometry");
    if (!geometry) continue;
    const Eigen::Isometry3d pose = link.pose * urdf_origin(collision);
    for (const XmlElement& shape : geometry->children())
      add_primitive(link, pose, shape, [&](const char* name, std::size_t count) {
        return shape.numbers(shape.required(name), count);
      });
  }
}

MechanismJoint urdf_joint(const XmlElement& element) {
  const std::string type = element.required("type");
  MechanismJoint joint{.name = element.required("name"),
                       .place = element.place(),
                       .element = element.index(),
                       .turns = type == "continuous" || type == "revolute",
                       .fixed = type == "fixed",
                       .axis = Eigen::Vector3d::UnitX()};
  const auto link_of = [&](const char* name) {
    const auto link = element.find(name);
    if (!link) element.fail("no <" + std::string(name) + ">", "<parent link=...> and <child link=...>");
    return link->required("link");
  };
  joint.parent = link_of("parent");
  joint.child = link_of("child");
  if (const auto axis = element.find("axis")) joint.axis = axis->vector(axis->required("xyz"));
  if (const auto dynamics = element.find("dynamics")) {
    joint.damping_Nm_s_rad = dynamics->number_at("damping").value_or(0);
    joint.friction_Nm = dynamics->number_at("friction").value_or(0);
  }
  if (const auto limit = element.find("limit"))
    joint.speed_rad_s = stated_speed_rad_s(limit->number_at("velocity"));
  return joint;
}

void refuse_xacro(const XmlElement& element) {
  if (element.name().starts_with("xacro:") && element.name() != "xacro:property")
    element.fail("an element of xacro", "a URDF without xacro",
                 "expand it: xacro robot.urdf.xacro > robot.urdf");
  for (const XmlElement& child : element.children()) refuse_xacro(child);
}

/// Joints hold links that exist, each link once, and one link is held by none.
void check_tree(const std::vector<XmlElement>& links, const std::vector<XmlElement>& joints,
                const std::vector<MechanismJoint>& read) {
  std::set<std::string> names, below;
  for (const XmlElement& link : links) names.insert(link.required("name"));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (const std::string& name : {read[i].parent, read[i].child})
      if (!names.contains(name))
        joints[i].fail("the link " + joulepath::quoted(name), "a <link> of this file");
    if (!below.insert(read[i].child).second)
      joints[i].fail("a second joint to " + joulepath::quoted(read[i].child), "one joint to each link");
  }
  std::string first;
  for (const XmlElement& link : links) {
    const std::string name = link.required("name");
    if (below.contains(name)) continue;
    if (!first.empty())
      link.fail("a second link that no joint holds, beside " + joulepath::quoted(first),
                "a tree of links and joints with one root");
    first = name;
  }
}

/// Joints with a transmission or with a velocity interface of ros2_control.
void mark_urdf_drives(const XmlElement& root, Mechanism& mechanism) {
  const auto mark = [&](const std::string& name) {
    for (MechanismJoint& joint : mechanism.joints)
      if (joint.name == name) joint.is_driven = true;
  };
  for (const XmlElement& transmission : root.children("transmission"))
    for (const XmlElement& joint : transmission.children("joint")) mark(joint.required("name"));
  for (const XmlElement& control : root.children("ros2_control"))
    for (const XmlElement& joint : control.children("joint"))
      for (const XmlElement& interface : joint.children("command_interface"))
        if (interface.attribute("name") == "velocity") mark(joint.required("name"));
}

}  // namespace

Eigen::Isometry3d placed(const Eigen::Vector3d& at_m, const Eigen::Vector3d& rpy_rad) {
  return Eigen::Translation3d(at_m) * Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX());
}

Eigen::Matrix3d inertia_of(const std::array<double, 6>& moments_kg_m2) {
  const auto& [xx, yy, zz, xy, xz, yz] = moments_kg_m2;
  return Eigen::Matrix3d{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
}

void add_primitive(MechanismLink& link, const Eigen::Isometry3d& pose, const XmlElement& shape,
                   const std::function<std::vector<double>(const char* name, std::size_t count)>& sizes) {
  const auto size = [&](const char* name) { return sizes(name, 1).front(); };
  const std::string kind = shape.name();
  if (kind == "box")
    add_shape(link, pose, box_points(Eigen::Vector3d(sizes("size", 3).data())));
  else if (kind == "cylinder")
    add_shape(link, pose, cylinder_points(size("radius"), size("length")), size("radius"));
  else if (kind == "capsule")
    add_balls(link, pose, capsule_ends(size("length")), size("radius"));
  else if (kind == "sphere")
    add_balls(link, pose, {Eigen::Vector3d::Zero()}, size("radius"));
  else
    link.has_mesh = true;
}

std::optional<double> stated_speed_rad_s(const std::optional<double>& limit) {
  constexpr double kNoLimit_rad_s = 1e6;
  return limit && *limit > 0 && *limit < kNoLimit_rad_s ? limit : std::nullopt;
}

Mechanism read_urdf(const XmlElement& root) {
  refuse_xacro(root);
  Mechanism mechanism{.file = root.file(), .name = root.attribute("name").value_or("")};
  std::map<std::string, Eigen::Isometry3d> pose_of;
  const std::vector<XmlElement> links = root.children("link"), joints = root.children("joint");
  for (const XmlElement& element : joints) mechanism.joints.push_back(urdf_joint(element));
  check_tree(links, joints, mechanism.joints);
  for (const XmlElement& element : links)
    if (const std::string name = element.required("name");
        std::ranges::find(mechanism.joints, name, &MechanismJoint::child) == mechanism.joints.end())
      pose_of[name] = Eigen::Isometry3d::Identity();
  for (std::size_t known = 0; known < pose_of.size();) {
    known = pose_of.size();
    for (std::size_t i = 0; i < joints.size(); ++i)
      if (const auto parent = pose_of.find(mechanism.joints[i].parent); parent != pose_of.end())
        pose_of[mechanism.joints[i].child] = parent->second * urdf_origin(joints[i]);
  }
  for (const XmlElement& element : links) {
    const auto pose = pose_of.find(element.required("name"));
    if (pose == pose_of.end()) element.fail("no way to it from the first link", "a tree of links and joints");
    MechanismLink link{
        .name = pose->first, .place = element.place(), .element = element.index(), .pose = pose->second};
    add_urdf_mass(element, link);
    add_urdf_shapes(element, link);
    mechanism.links.push_back(std::move(link));
  }
  for (MechanismJoint& joint : mechanism.joints)
    if (const auto child = pose_of.find(joint.child); child != pose_of.end()) {
      joint.place_m = child->second.translation();
      joint.axis = child->second.rotation() * joint.axis.normalized();
    }
  mark_urdf_drives(root, mechanism);
  read_drive_plugins(root, mechanism);
  return mechanism;
}

}  // namespace joulepath
