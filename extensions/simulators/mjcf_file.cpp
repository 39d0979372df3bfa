#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "extensions/simulators/model_files.hpp"
#include "scenarios/text/quoted.hpp"

namespace joulepath {
namespace {

constexpr double kWaterDensity_kg_m3 = 1000;  ///< of geoms that state neither mass nor density

/// Mass and moments of inertia about the center of a solid shape, in its frame.
struct SolidShape {
  double volume_m3{};
  Eigen::Vector3d moments_m2{Eigen::Vector3d::Zero()};  ///< per kg
  std::vector<Eigen::Vector3d> points_m{};
  std::optional<double> radius_m{};
  bool known{true};
};

SolidShape box_solid(const Eigen::Vector3d& half_m) {
  const Eigen::Vector3d s = half_m.cwiseProduct(half_m);
  return {.volume_m3 = 8 * half_m.prod(),
          .moments_m2 = Eigen::Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()) / 3,
          .points_m = box_points(2 * half_m)};
}

SolidShape ellipsoid_solid(const Eigen::Vector3d& half_m) {
  const Eigen::Vector3d s = half_m.cwiseProduct(half_m);
  SolidShape solid{.volume_m3 = 4 * std::numbers::pi / 3 * half_m.prod(),
                   .moments_m2 = Eigen::Vector3d(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()) / 5};
  for (const Eigen::Vector3d& point : sphere_points(1)) solid.points_m.push_back(point.cwiseProduct(half_m));
  Eigen::Vector3d sizes = half_m;
  std::ranges::sort(sizes);
  if (sizes[1] == sizes[2]) solid.radius_m = sizes[2];  // a ball, or round like a wheel
  return solid;
}

/// A cylinder, or with `round` the capsule that adds a half sphere at each end.
SolidShape round_solid(double r, double half_length_m, bool round) {
  const double h = 2 * half_length_m, barrel = std::numbers::pi * r * r * h;
  const double ball = round ? 4 * std::numbers::pi / 3 * r * r * r : 0;
  const double along = barrel * r * r / 2 + ball * 2 * r * r / 5;
  const double across =
      barrel * (r * r / 4 + h * h / 12) + ball * (2 * r * r / 5 + h * h / 4 + 3 * h * r / 8);
  const double volume = barrel + ball;
  return {.volume_m3 = volume,
          .moments_m2 = volume > 0 ? Eigen::Vector3d(Eigen::Vector3d(across, across, along) / volume)
                                   : Eigen::Vector3d(Eigen::Vector3d::Zero()),
          .points_m = cylinder_points(r, h + (round ? 2 * r : 0)),
          .radius_m = r};
}

class MjcfReader {
 public:
  explicit MjcfReader(const XmlElement& root) : root_(root) {
    mechanism_ = {.file = root.file(), .name = root.attribute("model").value_or("")};
    if (const auto include = root.descendants("include"); !include.empty())
      include.front().fail("an include", "one file",
                           "mujoco's compile sample writes one: compile model.xml whole.xml");
    for (const XmlElement& compiler : root.children("compiler")) {
      if (compiler.attribute("angle") == "radian") angle_ = 1.0;
      if (const auto order = compiler.attribute("eulerseq")) euler_ = *order;
      if (compiler.attribute("inertiafromgeom") == "true") always_from_geoms_ = true;
      if (compiler.attribute("settotalmass"))
        mechanism_.notes.push_back(compiler.place() +
                                   ": settotalmass is not applied: masses are those of the bodies");
    }
    for (const XmlElement& element : root.children("default")) add_defaults(element, "main");
  }

  Mechanism read() {
    const auto world = root_.find("worldbody");
    if (!world) root_.fail("no <worldbody>", "a model with bodies");
    for (const XmlElement& body : world->children("body"))
      add_body(body, Eigen::Isometry3d::Identity(), "", "");
    if (const auto actuators = root_.find("actuator"))
      for (const XmlElement& actuator : actuators->children()) mark_drive(actuator);
    return std::move(mechanism_);
  }

 private:
  void add_defaults(const XmlElement& element, const std::string& otherwise) {
    defaults_.emplace(element.attribute("class").value_or(otherwise), element);
    for (const XmlElement& below : element.children("default")) add_defaults(below, below.required("class"));
  }

  /// An attribute of an element, its own or that of its class; `inherited`: childclass of the bodies above.
  std::optional<std::string> value(const XmlElement& element, const char* name,
                                   const std::string& inherited) const {
    if (auto own = element.attribute(name)) return own;
    const std::string chosen = element.attribute("class").value_or(inherited.empty() ? "main" : inherited);
    const auto found = defaults_.find(chosen);
    if (found == defaults_.end()) {
      if (chosen != "main") element.fail("class " + joulepath::quoted(chosen), "a class of <default>");
      return std::nullopt;
    }
    for (std::optional<XmlElement> level = found->second; level && level->name() == "default";
         level = level->parent())
      if (const auto settings = level->find(element.name().c_str()))
        if (auto stated = settings->attribute(name)) return stated;
    return std::nullopt;
  }

  std::optional<Eigen::VectorXd> numbers(const XmlElement& element, const char* name,
                                         const std::string& inherited, std::size_t count = 0) const {
    const auto text = value(element, name, inherited);
    if (!text) return std::nullopt;
    const std::vector<double> all = element.numbers(*text, count);
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())));
  }

  Eigen::Isometry3d pose_of(const XmlElement& element, const std::string& inherited) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (const auto at = numbers(element, "pos", inherited, 3)) pose.translation() = *at;
    if (const auto q = numbers(element, "quat", inherited, 4))
      pose.linear() = Eigen::Quaterniond((*q)[0], (*q)[1], (*q)[2], (*q)[3]).normalized().toRotationMatrix();
    if (const auto a = numbers(element, "axisangle", inherited, 4))
      pose.linear() = Eigen::AngleAxisd(angle_ * (*a)[3], a->head<3>().normalized()).toRotationMatrix();
    if (const auto e = numbers(element, "euler", inherited, 3)) pose.linear() = turned(element, *e);
    if (const auto z = numbers(element, "zaxis", inherited, 3))
      pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(*z))
                          .toRotationMatrix();
    if (element.attribute("xyaxes")) element.fail("xyaxes", "quat, axisangle, euler or zaxis");
    return pose;
  }

  /// Lower case: about the turned axes; upper case: about the fixed ones.
  Eigen::Matrix3d turned(const XmlElement& element, const Eigen::VectorXd& angles) const {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (Eigen::Index i = 0; i < 3; ++i) {
      const char axis = euler_.size() == 3 ? euler_[static_cast<std::size_t>(i)] : '?';
      const auto index =
          std::string("xyz").find(static_cast<char>(std::tolower(static_cast<unsigned char>(axis))));
      if (index == std::string::npos)
        element.fail("eulerseq " + joulepath::quoted(euler_), "three of x, y, z");
      const Eigen::Matrix3d one =
          Eigen::AngleAxisd(angle_ * angles[i], Eigen::Vector3d::Unit(static_cast<Eigen::Index>(index)))
              .toRotationMatrix();
      turn = std::islower(static_cast<unsigned char>(axis)) ? Eigen::Matrix3d(turn * one)
                                                            : Eigen::Matrix3d(one * turn);
    }
    return turn;
  }

  SolidShape solid_of(const XmlElement& geom, const std::string& inherited, Eigen::Isometry3d& pose) const {
    const std::string type = value(geom, "type", inherited).value_or("sphere");
    const auto size = numbers(geom, "size", inherited);
    const auto at = [&](Eigen::Index i) {
      if (!size || size->size() <= i) geom.fail("too few sizes of a " + type, "sizes in metres");
      return (*size)[i];
    };
    double half_length_m = 0;
    const auto ends = numbers(geom, "fromto", inherited, 6);
    if (ends) {
      const Eigen::Vector3d from = ends->head<3>(), to = ends->tail<3>();
      half_length_m = 0.5 * (to - from).norm();
      pose = Eigen::Translation3d(0.5 * (from + to)) *
             Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(to - from));
    }
    if (type == "sphere") return ellipsoid_solid(Eigen::Vector3d::Constant(at(0)));
    if (type == "capsule" || type == "cylinder")
      return round_solid(at(0), ends ? half_length_m : at(1), type == "capsule");
    if (type == "box" || type == "ellipsoid") {
      if (ends) geom.fail("fromto of a " + type, "fromto of a capsule or a cylinder");
      const Eigen::Vector3d half_m(at(0), at(1), at(2));
      return type == "box" ? box_solid(half_m) : ellipsoid_solid(half_m);
    }
    return {.known = false};
  }

  void add_geom(const XmlElement& geom, const std::string& inherited, MechanismLink& link,
                std::vector<MechanismLink>& parts) {
    Eigen::Isometry3d pose = pose_of(geom, inherited);
    const SolidShape solid = solid_of(geom, inherited, pose);
    pose = link.pose * pose;
    const auto is_zero = [&](const char* name) { return value(geom, name, inherited).value_or("1") == "0"; };
    if (!(is_zero("contype") && is_zero("conaffinity"))) {
      if (solid.known)
        add_shape(link, pose, solid.points_m, solid.radius_m);
      else
        link.has_mesh = true;
    }
    const auto mass = numbers(geom, "mass", inherited, 1), density = numbers(geom, "density", inherited, 1);
    if (mass && (*mass)[0] == 0) return;
    if (density && (*density)[0] == 0 && !mass) return;
    if (!solid.known) {
      unknown_mass_ = geom.place();
      return;
    }
    MechanismLink part{.has_mass = true, .center_m = pose.translation()};
    part.mass_kg = mass ? (*mass)[0] : (density ? (*density)[0] : kWaterDensity_kg_m3) * solid.volume_m3;
    part.inertia_kg_m2 =
        part.mass_kg * (pose.rotation() * solid.moments_m2.asDiagonal() * pose.rotation().transpose());
    parts.push_back(std::move(part));
  }

  void add_inertial(const XmlElement& inertial, const std::string& inherited, MechanismLink& link) const {
    const Eigen::Isometry3d pose = link.pose * pose_of(inertial, inherited);
    link.has_mass = true;
    link.mass_kg = inertial.number(inertial.required("mass"));
    link.center_m = pose.translation();
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    if (const auto d = numbers(inertial, "diaginertia", "", 3)) own = d->asDiagonal();
    if (const auto f = numbers(inertial, "fullinertia", "", 6))
      own << (*f)[0], (*f)[3], (*f)[4], (*f)[3], (*f)[1], (*f)[5], (*f)[4], (*f)[5], (*f)[2];
    link.inertia_kg_m2 = pose.rotation() * own * pose.rotation().transpose();
  }

  void add_joints(const XmlElement& body, const std::string& parent, const std::string& inherited,
                  const MechanismLink& link) {
    const std::vector<XmlElement> joints = body.children("joint");
    if (joints.empty() && !body.find("freejoint") && !parent.empty())
      mechanism_.joints.push_back(
          {.name = link.name, .place = body.place(), .parent = parent, .child = link.name, .fixed = true});
    for (const XmlElement& element : joints) {
      const auto number = [&](const char* name) {
        const auto stated = numbers(element, name, inherited);
        return stated && stated->size() > 0 ? (*stated)[0] : 0.0;
      };
      const auto axis = numbers(element, "axis", inherited, 3), at = numbers(element, "pos", inherited, 3);
      MechanismJoint joint{.name = element.attribute("name").value_or(link.name),
                           .place = element.place(),
                           .parent = parent,
                           .child = link.name,
                           .turns = value(element, "type", inherited).value_or("hinge") == "hinge"};
      joint.place_m = link.pose * (at ? Eigen::Vector3d(*at) : Eigen::Vector3d(Eigen::Vector3d::Zero()));
      joint.axis = link.pose.rotation() *
                   (axis ? Eigen::Vector3d(axis->normalized()) : Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
      joint.damping_Nm_s_rad = number("damping");
      joint.friction_Nm = number("frictionloss");
      joint.rotor_inertia_kg_m2 = number("armature");
      mechanism_.joints.push_back(std::move(joint));
    }
  }

  void add_body(const XmlElement& body, const Eigen::Isometry3d& above, const std::string& parent,
                const std::string& inherited_above) {
    const std::string inherited = body.attribute("childclass").value_or(inherited_above);
    MechanismLink link{.name = body.attribute("name").value_or("body in line " + std::to_string(body.line())),
                       .place = body.place(),
                       .pose = above * pose_of(body, "")};
    std::vector<MechanismLink> parts;
    unknown_mass_.clear();
    for (const XmlElement& geom : body.children("geom")) add_geom(geom, inherited, link, parts);
    const auto inertial = body.find("inertial");
    if (inertial && !always_from_geoms_) {
      add_inertial(*inertial, inherited, link);
    } else if (!unknown_mass_.empty()) {
      mechanism_.notes.push_back(unknown_mass_ + ": the mass of " + link.name +
                                 " follows from a mesh, which is not read: write <inertial>");
    } else if (!parts.empty()) {
      std::vector<const MechanismLink*> all;
      for (const MechanismLink& part : parts) all.push_back(&part);
      const MechanismLink whole = combined(all);
      link.has_mass = true;
      link.mass_kg = whole.mass_kg;
      link.center_m = whole.center_m;
      link.inertia_kg_m2 = whole.inertia_kg_m2;
    }
    add_joints(body, parent, inherited, link);
    const Eigen::Isometry3d pose = link.pose;
    const std::string name = link.name;
    mechanism_.links.push_back(std::move(link));
    for (const XmlElement& below : body.children("body")) add_body(below, pose, name, inherited);
  }

  /// A velocity actuator's range is a speed limit of its joint.
  void mark_drive(const XmlElement& actuator) {
    const std::string name = actuator.attribute("joint").value_or("");
    for (MechanismJoint& joint : mechanism_.joints) {
      if (joint.name != name) continue;
      joint.is_driven = true;
      if (actuator.name() != "velocity") continue;
      const auto range = numbers(actuator, "ctrlrange", "", 2), gear = numbers(actuator, "gear", "");
      if (range) joint.speed_rad_s = (*range)[1] / (gear && (*gear)[0] > 0 ? (*gear)[0] : 1.0);
    }
  }

  XmlElement root_;
  Mechanism mechanism_{};
  std::map<std::string, XmlElement> defaults_{};
  double angle_{std::numbers::pi / 180};
  std::string euler_{"xyz"};
  bool always_from_geoms_{};
  std::string unknown_mass_{};  ///< the place of a geom of the body that is read now
};

}  // namespace

Mechanism read_mjcf(const XmlElement& root) { return MjcfReader(root).read(); }

Mechanism read_mechanism(const std::string& file) {
  const XmlFile xml(file);
  const XmlElement root = xml.root();
  if (root.name() == "robot") return read_urdf(root);
  if (root.name() == "sdf") return read_sdf(root);
  if (root.name() == "mujoco") return read_mjcf(root);
  root.fail("<" + root.name() + ">", "<robot> (URDF), <sdf> or <mujoco> (MJCF)");
}

}  // namespace joulepath
