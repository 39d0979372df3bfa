#include <algorithm>
#include <cctype>
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
  std::vector<Eigen::Vector3d> balls_m{};  ///< centers of balls with `radius_m`
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

SolidShape ball_solid(double radius_m) {
  SolidShape solid = ellipsoid_solid(Eigen::Vector3d::Constant(radius_m));
  solid.points_m.clear();
  solid.balls_m = {Eigen::Vector3d::Zero()};
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
          .points_m = round ? std::vector<Eigen::Vector3d>() : cylinder_points(r, h),
          .balls_m = round ? capsule_ends(h) : std::vector<Eigen::Vector3d>(),
          .radius_m = r};
}

/// A class of defaults: its sections, and the class that it is in.
struct DefaultClass {
  std::string above{};
  std::vector<XmlElement> sections{};
};

/// An element of a body, with the frames around it.
struct FramedElement {
  XmlElement element;
  Eigen::Isometry3d frame;  ///< in the body's frame
  std::string inherited;    ///< childclass around it
};

constexpr const char* kOrientations[] = {"quat", "axisangle", "euler", "zaxis", "xyaxes"};

Eigen::VectorXd numbers_in(const XmlElement& element, const std::string& text, std::size_t count) {
  const std::vector<double> all = element.numbers(text, count);
  return Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
}

class MjcfReader {
 public:
  explicit MjcfReader(const XmlElement& root)
      : root_(root), mechanism_{.file = root.file(), .name = root.attribute("model").value_or("")} {
    for (const char* kind : {"include", "attach", "replicate", "composite"})
      if (const auto found = root.descendants(kind); !found.empty())
        found.front().fail("<" + std::string(kind) + ">", "bodies that the file itself states",
                           "mujoco's compile sample writes one file: compile model.xml whole.xml");
    for (const XmlElement& compiler : root.children("compiler")) {
      if (compiler.attribute("angle") == "radian") angle_ = 1.0;
      if (const auto order = compiler.attribute("eulerseq")) euler_ = *order;
      if (compiler.attribute("inertiafromgeom") == "true") always_from_geoms_ = true;
      if (compiler.attribute("settotalmass"))
        mechanism_.notes.push_back(compiler.place() +
                                   ": settotalmass is not applied: masses are those of the bodies");
    }
    for (const XmlElement& element : root.children("default")) add_defaults(element, "main", "");
  }

  Mechanism read() {
    const std::vector<XmlElement> worlds = root_.children("worldbody");
    if (worlds.empty()) root_.fail("no <worldbody>", "a model with bodies");
    for (const XmlElement& world : worlds)
      for (const FramedElement& body : contents(world, "body", ""))
        add_body(body.element, body.frame, "", body.inherited);
    for (const XmlElement& actuators : root_.children("actuator"))
      for (const XmlElement& actuator : actuators.children()) mark_drive(actuator);
    return std::move(mechanism_);
  }

 private:
  /// Sections of one class merge; the first one tells which class it is in.
  void add_defaults(const XmlElement& element, const std::string& otherwise, const std::string& above) {
    const std::string name = element.attribute("class").value_or(otherwise);
    defaults_.try_emplace(name, DefaultClass{.above = above}).first->second.sections.push_back(element);
    for (const XmlElement& below : element.children("default"))
      add_defaults(below, below.required("class"), name);
  }

  /// The element, then the settings of its class and of the classes around that, as they count;
  /// `inherited`: childclass of the bodies above.
  std::vector<XmlElement> sources(const XmlElement& element, const std::string& inherited) const {
    std::vector<XmlElement> all{element};
    const std::string chosen = element.attribute("class").value_or(inherited.empty() ? "main" : inherited);
    auto level = defaults_.find(chosen);
    if (level == defaults_.end() && chosen != "main")
      element.fail("class " + joulepath::quoted(chosen), "a class of <default>");
    for (; level != defaults_.end(); level = defaults_.find(level->second.above))
      for (auto section = level->second.sections.rbegin(); section != level->second.sections.rend();
           ++section)
        for (const XmlElement& settings : section->children(element.name().c_str())) all.push_back(settings);
    return all;
  }

  /// An attribute of an element, its own or that of its class.
  std::optional<std::string> value(const XmlElement& element, const char* name,
                                   const std::string& inherited) const {
    for (const XmlElement& source : sources(element, inherited))
      if (auto stated = source.attribute(name)) return stated;
    return std::nullopt;
  }

  /// The children of a kind, those in frames too.
  std::vector<FramedElement> contents(const XmlElement& body, const std::string& kind,
                                      const std::string& inherited) const {
    std::vector<FramedElement> all;
    for (const XmlElement& child : body.children()) {
      if (child.name() == kind) all.push_back({child, Eigen::Isometry3d::Identity(), inherited});
      if (child.name() != "frame") continue;
      const Eigen::Isometry3d frame = pose_of(child, "");
      for (FramedElement& inside : contents(child, kind, child.attribute("childclass").value_or(inherited))) {
        inside.frame = frame * inside.frame;
        all.push_back(std::move(inside));
      }
    }
    return all;
  }

  std::optional<Eigen::VectorXd> numbers(const XmlElement& element, const char* name,
                                         const std::string& inherited, std::size_t count = 0) const {
    const auto text = value(element, name, inherited);
    if (!text) return std::nullopt;
    return numbers_in(element, *text, count);
  }

  Eigen::Isometry3d pose_of(const XmlElement& element, const std::string& inherited) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (const auto at = numbers(element, "pos", inherited, 3)) pose.translation() = *at;
    for (const XmlElement& source : sources(element, inherited))
      for (const char* kind : kOrientations)
        if (const auto text = source.attribute(kind)) {
          pose.linear() = orientation(source, kind, *text);
          return pose;
        }
    return pose;
  }

  Eigen::Matrix3d orientation(const XmlElement& source, const std::string& kind,
                              const std::string& text) const {
    const std::size_t count = kind == "xyaxes" ? 6 : kind == "quat" || kind == "axisangle" ? 4 : 3;
    const Eigen::VectorXd v = numbers_in(source, text, count);
    if (kind == "quat") return Eigen::Quaterniond(v[0], v[1], v[2], v[3]).normalized().toRotationMatrix();
    if (kind == "axisangle")
      return Eigen::AngleAxisd(angle_ * v[3], v.head<3>().normalized()).toRotationMatrix();
    if (kind == "euler") return turned(source, v);
    if (kind == "zaxis")
      return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(v))
          .toRotationMatrix();
    Eigen::Matrix3d axes;
    axes.col(0) = v.head<3>().normalized();
    axes.col(1) = (v.tail<3>() - axes.col(0).dot(v.tail<3>()) * axes.col(0)).normalized();
    axes.col(2) = axes.col(0).cross(axes.col(1));
    if (!(std::abs(axes.determinant() - 1) < 1e-6)) source.fail("xyaxes along one line", "two directions");
    return axes;
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
    if (type == "sphere") return ball_solid(at(0));
    if (type == "capsule" || type == "cylinder")
      return round_solid(at(0), ends ? half_length_m : at(1), type == "capsule");
    if (type == "box" || type == "ellipsoid") {
      if (ends) geom.fail("fromto of a " + type, "fromto of a capsule or a cylinder");
      const Eigen::Vector3d half_m(at(0), at(1), at(2));
      return type == "box" ? box_solid(half_m) : ellipsoid_solid(half_m);
    }
    return {.known = false};
  }

  void add_geom(const FramedElement& framed, MechanismLink& link, std::vector<MechanismLink>& parts) {
    const auto& [geom, frame, inherited] = framed;
    Eigen::Isometry3d pose = pose_of(geom, inherited);
    const SolidShape solid = solid_of(geom, inherited, pose);
    pose = link.pose * frame * pose;
    add_outline(framed, solid, pose, link);
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

  void add_outline(const FramedElement& geom, const SolidShape& solid, const Eigen::Isometry3d& pose,
                   MechanismLink& link) const {
    const auto is_zero = [&](const char* name) {
      return value(geom.element, name, geom.inherited).value_or("1") == "0";
    };
    if (is_zero("contype") && is_zero("conaffinity")) return;
    if (!solid.known)
      link.has_mesh = true;
    else if (solid.balls_m.empty())
      add_shape(link, pose, solid.points_m, solid.radius_m);
    else
      add_balls(link, pose, solid.balls_m, *solid.radius_m);
  }

  void add_inertial(const XmlElement& inertial, const std::string& inherited, MechanismLink& link) const {
    const Eigen::Isometry3d pose = link.pose * pose_of(inertial, inherited);
    link.has_mass = true;
    link.mass_kg = inertial.number(inertial.required("mass"));
    link.center_m = pose.translation();
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
    if (const auto d = numbers(inertial, "diaginertia", "", 3)) own = d->asDiagonal();
    if (const auto f = numbers(inertial, "fullinertia", "", 6))
      own = inertia_of({(*f)[0], (*f)[1], (*f)[2], (*f)[3], (*f)[4], (*f)[5]});
    link.inertia_kg_m2 = pose.rotation() * own * pose.rotation().transpose();
  }

  void add_joints(const XmlElement& body, const std::string& parent, const std::string& inherited,
                  const MechanismLink& link) {
    const std::vector<FramedElement> joints = contents(body, "joint", inherited);
    if (joints.empty() && contents(body, "freejoint", "").empty() && !parent.empty())
      mechanism_.joints.push_back({.name = link.name,
                                   .place = body.place(),
                                   .element = body.index(),
                                   .parent = parent,
                                   .child = link.name,
                                   .fixed = true});
    for (const FramedElement& framed : joints) {
      const XmlElement& element = framed.element;
      const Eigen::Isometry3d frame = link.pose * framed.frame;
      const auto number = [&](const char* name) {
        const auto stated = numbers(element, name, framed.inherited);
        return stated && stated->size() > 0 ? (*stated)[0] : 0.0;
      };
      const auto axis = numbers(element, "axis", framed.inherited, 3),
                 at = numbers(element, "pos", framed.inherited, 3);
      MechanismJoint joint{.name = element.attribute("name").value_or(link.name),
                           .place = element.place(),
                           .element = element.index(),
                           .parent = parent,
                           .child = link.name,
                           .turns = value(element, "type", framed.inherited).value_or("hinge") == "hinge"};
      joint.place_m = frame * (at ? Eigen::Vector3d(*at) : Eigen::Vector3d(Eigen::Vector3d::Zero()));
      joint.axis = frame.rotation() *
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
                       .element = body.index(),
                       .pose = above * pose_of(body, "")};
    std::vector<MechanismLink> parts;
    unknown_mass_.clear();
    for (const FramedElement& geom : contents(body, "geom", inherited)) add_geom(geom, link, parts);
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
    for (const FramedElement& below : contents(body, "body", inherited))
      add_body(below.element, pose * below.frame, name, below.inherited);
  }

  /// A velocity actuator's range is a speed limit of its joint.
  void mark_drive(const XmlElement& actuator) {
    const std::string name = actuator.attribute("joint").value_or("");
    for (MechanismJoint& joint : mechanism_.joints) {
      if (joint.name != name) continue;
      joint.is_driven = true;
      if (actuator.name() == "velocity") joint.speed_rad_s = stated_speed_rad_s(speed_of(actuator));
    }
  }

  /// The control is the speed of the transmission: gear times that of the joint, of either sign.
  std::optional<double> speed_of(const XmlElement& actuator) const {
    const auto range = numbers(actuator, "ctrlrange", "", 2), gear = numbers(actuator, "gear", "");
    if (gear && (gear->size() == 0 || (*gear)[0] == 0))
      actuator.fail("a gear without a number or of 0", "one number or more, the first not 0");
    if (!range || value(actuator, "ctrllimited", "") == "false") return std::nullopt;
    return range->cwiseAbs().maxCoeff() / (gear ? std::abs((*gear)[0]) : 1.0);
  }

  XmlElement root_;
  Mechanism mechanism_{};
  std::map<std::string, DefaultClass> defaults_{};
  double angle_{std::numbers::pi / 180};
  std::string euler_{"xyz"};
  bool always_from_geoms_{};
  std::string unknown_mass_{};  ///< the place of a geom of the body that is read now
};

}  // namespace

Mechanism read_mjcf(const XmlElement& root) { return MjcfReader(root).read(); }

Mechanism read_mechanism(const XmlElement& root) {
  if (root.name() == "robot") return read_urdf(root);
  if (root.name() == "sdf") return read_sdf(root);
  if (root.name() != "mujoco") root.fail("<" + root.name() + ">", "<robot> (URDF), <sdf> or <mujoco> (MJCF)");
  return read_mjcf(root);
}

}  // namespace joulepath
