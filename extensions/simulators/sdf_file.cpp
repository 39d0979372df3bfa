#include <map>
#include <numbers>

#include "extensions/simulators/model_files.hpp"
#include "scenarios/text/quoted.hpp"

namespace joulepath {
namespace {

constexpr int kDeepestFrames = 50;  ///< a frame that stands on more others stands on itself

bool is_true(const std::string& text) { return text == "true" || text == "1"; }

/// `<pose>` of an element: x y z roll pitch yaw, or with a quaternion.
Eigen::Isometry3d sdf_pose(const XmlElement& element) {
  const auto pose = element.find("pose");
  if (!pose || pose->text().empty()) return Eigen::Isometry3d::Identity();
  const bool quaternion = pose->attribute("rotation_format") == "quat_xyzw";
  const std::vector<double> p = pose->numbers(pose->text(), quaternion ? 7 : 6);
  if (quaternion)
    return Eigen::Translation3d(p[0], p[1], p[2]) * Eigen::Quaterniond(p[6], p[3], p[4], p[5]).normalized();
  const double unit = is_true(pose->attribute("degrees").value_or("")) ? std::numbers::pi / 180 : 1.0;
  return placed({p[0], p[1], p[2]}, unit * Eigen::Vector3d(p[3], p[4], p[5]));
}

/// The frames of a model: its links, joints and frames by name.
class SdfFrames {
 public:
  explicit SdfFrames(const XmlElement& model) {
    for (const char* kind : {"link", "joint", "frame"})
      for (const XmlElement& element : model.children(kind))
        named_.emplace(element.required("name"), element);
  }

  Eigen::Isometry3d pose_of(const XmlElement& element, int depth = 0) const {
    if (depth > kDeepestFrames)
      element.fail("a frame that stands on itself", "poses from the model's frame on");
    std::string base;
    if (element.name() == "joint" && element.find("child")) base = element.find("child")->text();
    if (element.name() == "frame") base = element.attribute("attached_to").value_or("");
    if (const auto pose = element.find("pose")) base = pose->attribute("relative_to").value_or(base);
    if (base.empty() || base == "__model__") return sdf_pose(element);
    const auto found = named_.find(base);
    if (found == named_.end())
      element.fail("the frame " + joulepath::quoted(base), "a link, joint or frame of the same model");
    return pose_of(found->second, depth + 1) * sdf_pose(element);
  }

 private:
  std::map<std::string, XmlElement> named_{};
};

void add_sdf_mass(const XmlElement& element, MechanismLink& link) {
  const auto inertial = element.find("inertial");
  const auto mass = inertial ? inertial->number_in("mass") : std::nullopt;
  if (!mass) return;
  const Eigen::Isometry3d pose = link.pose * sdf_pose(*inertial);
  Eigen::Matrix3d own = Eigen::Matrix3d::Identity();  // the format's default
  if (const auto inertia = inertial->find("inertia")) {
    const auto moment = [&](const char* name, double otherwise) {
      return inertia->number_in(name).value_or(otherwise);
    };
    own << moment("ixx", 1), moment("ixy", 0), moment("ixz", 0), moment("ixy", 0), moment("iyy", 1),
        moment("iyz", 0), moment("ixz", 0), moment("iyz", 0), moment("izz", 1);
  }
  link.has_mass = true;
  link.mass_kg = *mass;
  link.center_m = pose.translation();
  link.inertia_kg_m2 = pose.rotation() * own * pose.rotation().transpose();
}

void add_sdf_shapes(const XmlElement& element, MechanismLink& link) {
  for (const XmlElement& collision : element.children("collision")) {
    const auto geometry = collision.find("geometry");
    if (!geometry) continue;
    const Eigen::Isometry3d pose = link.pose * sdf_pose(collision);
    const auto size = [](const XmlElement& shape, const char* name) {
      const auto value = shape.number_in(name);
      if (!value) shape.fail("no <" + std::string(name) + ">", "a size in metres");
      return *value;
    };
    for (const XmlElement& shape : geometry->children())
      if (shape.name() == "box") {
        const auto sides = shape.find("size");
        if (!sides) shape.fail("no <size>", "x y z in metres");
        add_shape(link, pose, box_points(sides->vector(sides->text())));
      } else if (shape.name() == "cylinder" || shape.name() == "capsule") {
        add_shape(link, pose, cylinder_points(size(shape, "radius"), size(shape, "length")),
                  size(shape, "radius"));
      } else if (shape.name() == "sphere") {
        add_shape(link, pose, sphere_points(size(shape, "radius")), size(shape, "radius"));
      } else {
        link.has_mesh = true;
      }
  }
}

MechanismJoint sdf_joint(const XmlElement& element, const SdfFrames& frames) {
  const auto type = element.required("type");
  const auto parent = element.find("parent"), child = element.find("child"), axis = element.find("axis");
  if (!parent || !child) element.fail("no parent or no child", "<parent> and <child>");
  MechanismJoint joint{.name = element.required("name"),
                       .place = element.place(),
                       .parent = parent->text(),
                       .child = child->text(),
                       .turns = type == "revolute" || type == "continuous",
                       .fixed = type == "fixed"};
  const Eigen::Isometry3d pose = frames.pose_of(element);
  joint.place_m = pose.translation();
  if (!axis) return joint;
  if (const auto xyz = axis->find("xyz")) {
    const bool in_model =
        xyz->attribute("expressed_in") == "__model__" ||
        (axis->find("use_parent_model_frame") && is_true(axis->find("use_parent_model_frame")->text()));
    const Eigen::Vector3d direction = xyz->vector(xyz->text()).normalized();
    joint.axis = in_model ? direction : Eigen::Vector3d(pose.rotation() * direction);
  }
  if (const auto dynamics = axis->find("dynamics")) {
    joint.damping_Nm_s_rad = dynamics->number_in("damping").value_or(0);
    joint.friction_Nm = dynamics->number_in("friction").value_or(0);
  }
  if (const auto limit = axis->find("limit"))
    if (const auto speed = limit->number_in("velocity"); speed && *speed > 0 && *speed < 1e6)
      joint.speed_rad_s = speed;
  return joint;
}

}  // namespace

Mechanism read_sdf(const XmlElement& root) {
  std::vector<XmlElement> models = root.descendants("model");
  if (models.size() > 1)  // of a world: the one that drives
    std::erase_if(models, [](const XmlElement& model) {
      Mechanism plugins;
      for (const XmlElement& inside : model.children("model")) read_drive_plugins(inside, plugins);
      const std::size_t nested = plugins.left.size();
      read_drive_plugins(model, plugins);
      return plugins.left.size() == nested;
    });
  if (models.size() != 1)
    root.fail(std::to_string(models.size()) + " models that drive", "one <model>, or one with a drive plugin",
              "gz sdf -p FILE writes includes and nested models into one file");
  const XmlElement& model = models.front();
  Mechanism mechanism{.file = root.file(), .name = model.attribute("name").value_or("")};
  for (const XmlElement& include : model.children("include"))
    mechanism.notes.push_back(include.place() + ": <include> is not read: its masses are missing");
  const SdfFrames frames(model);
  for (const XmlElement& element : model.children("link")) {
    MechanismLink link{
        .name = element.required("name"), .place = element.place(), .pose = frames.pose_of(element)};
    add_sdf_mass(element, link);
    add_sdf_shapes(element, link);
    mechanism.links.push_back(std::move(link));
  }
  for (const XmlElement& element : model.children("joint"))
    mechanism.joints.push_back(sdf_joint(element, frames));
  read_drive_plugins(model, mechanism);
  return mechanism;
}

}  // namespace joulepath
