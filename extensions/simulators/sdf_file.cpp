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
    return pose_named(base, element, depth) * sdf_pose(element);
  }

  /// A frame that `element` names; none and __model__: the model's.
  Eigen::Isometry3d pose_named(const std::string& name, const XmlElement& element, int depth = 0) const {
    if (name.empty() || name == "__model__") return Eigen::Isometry3d::Identity();
    const auto found = named_.find(name);
    if (found == named_.end())
      element.fail("the frame " + joulepath::quoted(name), "a link, joint or frame of the same model");
    return pose_of(found->second, depth + 1);
  }

  /// The pose of a part of a link: in the link's frame, or relative to a named one.
  Eigen::Isometry3d pose_in(const MechanismLink& link, const XmlElement& part) const {
    const auto pose = part.find("pose");
    const auto base = pose ? pose->attribute("relative_to") : std::nullopt;
    return (base ? pose_named(*base, part) : link.pose) * sdf_pose(part);
  }

 private:
  std::map<std::string, XmlElement> named_{};
};

void add_sdf_mass(const XmlElement& element, const SdfFrames& frames, MechanismLink& link) {
  const auto inertial = element.find("inertial");
  const auto mass = inertial ? inertial->number_in("mass") : std::nullopt;
  if (!mass) return;
  const Eigen::Isometry3d pose = frames.pose_in(link, *inertial);
  Eigen::Matrix3d own = Eigen::Matrix3d::Identity();  // the format's default
  if (const auto inertia = inertial->find("inertia")) {
    const auto moment = [&](const char* name, double otherwise) {
      return inertia->number_in(name).value_or(otherwise);
    };
    own = inertia_of({moment("ixx", 1), moment("iyy", 1), moment("izz", 1), moment("ixy", 0),
                      moment("ixz", 0), moment("iyz", 0)});
  }
  link.has_mass = true;
  link.mass_kg = *mass;
  link.center_m = pose.translation();
  link.inertia_kg_m2 = pose.rotation() * own * pose.rotation().transpose();
}

void add_sdf_shapes(const XmlElement& element, const SdfFrames& frames, MechanismLink& link) {
  for (const XmlElement& collision : element.children("collision")) {
    const auto geometry = collision.find("geometry");
    if (!geometry) continue;
    const Eigen::Isometry3d pose = frames.pose_in(link, collision);
    for (const XmlElement& shape : geometry->children())
      add_primitive(link, pose, shape, [&](const char* name, std::size_t count) {
        const auto value = shape.find(name);
        if (!value) shape.fail("no <" + std::string(name) + ">", "a size in metres");
        return value->numbers(value->text(), count);
      });
  }
}

/// Until version 1.4 axes are in the model's frame, later in the joint's unless they say otherwise.
bool has_axes_in_model(const XmlElement& root) {
  const std::string version = root.attribute("version").value_or("");
  return version.size() == 3 && version.starts_with("1.") && version[2] < '5';
}

/// The rotation of the frame in which an axis is stated.
Eigen::Matrix3d frame_of_axis(const XmlElement& axis, const XmlElement& xyz, const SdfFrames& frames,
                              const Eigen::Isometry3d& joint, bool axes_in_model) {
  if (const auto named = xyz.attribute("expressed_in"); named && !named->empty())
    return frames.pose_named(*named, xyz).rotation();
  const auto stated = axis.find("use_parent_model_frame");
  const bool in_model = stated ? is_true(stated->text()) : axes_in_model;
  return in_model ? Eigen::Matrix3d::Identity() : Eigen::Matrix3d(joint.rotation());
}

MechanismJoint sdf_joint(const XmlElement& element, const SdfFrames& frames, bool axes_in_model) {
  const auto type = element.required("type");
  const auto parent = element.find("parent"), child = element.find("child"), axis = element.find("axis");
  if (!parent || !child) element.fail("no parent or no child", "<parent> and <child>");
  MechanismJoint joint{.name = element.required("name"),
                       .place = element.place(),
                       .element = element.index(),
                       .parent = parent->text(),
                       .child = child->text(),
                       .turns = type == "revolute" || type == "continuous",
                       .fixed = type == "fixed"};
  const Eigen::Isometry3d pose = frames.pose_of(element);
  joint.place_m = pose.translation();
  if (!axis) return joint;
  if (const auto xyz = axis->find("xyz"))
    joint.axis =
        frame_of_axis(*axis, *xyz, frames, pose, axes_in_model) * xyz->vector(xyz->text()).normalized();
  if (const auto dynamics = axis->find("dynamics")) {
    joint.damping_Nm_s_rad = dynamics->number_in("damping").value_or(0);
    joint.friction_Nm = dynamics->number_in("friction").value_or(0);
  }
  if (const auto limit = axis->find("limit"))
    joint.speed_rad_s = stated_speed_rad_s(limit->number_in("velocity"));
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
  for (const char* kind : {"include", "model"})
    for (const XmlElement& inside : model.children(kind))
      mechanism.notes.push_back(inside.place() + ": <" + kind + "> is not read: its masses are missing");
  const SdfFrames frames(model);
  for (const XmlElement& element : model.children("link")) {
    MechanismLink link{.name = element.required("name"),
                       .place = element.place(),
                       .element = element.index(),
                       .pose = frames.pose_of(element)};
    add_sdf_mass(element, frames, link);
    add_sdf_shapes(element, frames, link);
    mechanism.links.push_back(std::move(link));
  }
  for (const XmlElement& element : model.children("joint"))
    mechanism.joints.push_back(sdf_joint(element, frames, has_axes_in_model(root)));
  read_drive_plugins(model, mechanism);
  return mechanism;
}

}  // namespace joulepath
