#include "extensions/simulators/mechanism_draft.hpp"

#include <algorithm>
#include <cmath>

#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/text/counted.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

constexpr double kSameLength = 0.01;  ///< relative: lengths of a plugin and of a shape that agree

using Names = std::vector<std::string>;

[[noreturn]] void refuse(const Mechanism& mechanism, std::string found, std::string accepted,
                         std::string hint) {
  throw ConfigError({{mechanism.file, 1, 1}, "", std::move(found), std::move(accepted), std::move(hint)});
}

/// One driven wheel with what is fixed to it.
struct DraftWheel {
  const MechanismJoint* joint{};
  Names links{};
  MechanismLink body{};
  const MechanismLink* shape{};  ///< the link with the radius; null: none
  Eigen::Vector3d contact_m{Eigen::Vector3d::Zero()};

  double axle_inertia_kg_m2() const {
    return joint->axis.dot(body.inertia_kg_m2 * joint->axis) + joint->rotor_inertia_kg_m2;
  }
  double diameter_inertia_kg_m2() const {
    return 0.5 * (body.inertia_kg_m2.trace() - joint->axis.dot(body.inertia_kg_m2 * joint->axis));
  }
};

class DraftOfMechanism {
 public:
  DraftOfMechanism(const Mechanism& mechanism, const Names& wheels) : mechanism_(mechanism) {
    const auto [left, right] = drive_joints(wheels);
    left_ = wheel_at(*left);
    right_ = wheel_at(*right);
    const Eigen::Vector3d across = left_.contact_m - right_.contact_m;
    if (!(across.norm() > 1e-6))
      refuse(mechanism, "both drive wheels at one place", "a left and a right wheel", "");
    left_is_y_ = across.normalized();
    forward_ = left_is_y_.cross(Eigen::Vector3d::UnitZ()).normalized();
    middle_m_ = 0.5 * (left_.contact_m + right_.contact_m);
    for (const MechanismLink& link : mechanism.links)
      if (!names(left_.links, link.name) && !names(right_.links, link.name)) chassis_links_.push_back(&link);
    chassis_ = combined(chassis_links_);
  }

  DriveParts parts() const {
    DriveParts parts{.joint = {left_.joint, right_.joint}};
    for (const MechanismLink& link : mechanism_.links)
      for (const Side side : kSides)
        if (names((side == Side::left ? left_ : right_).links, link.name)) parts.links[side].push_back(&link);
    const auto heaviest = std::ranges::max_element(chassis_links_, {}, &MechanismLink::mass_kg);
    if (chassis_.mass_kg > 0) parts.heaviest = *heaviest;
    for (const Side side : kSides)
      if (const DraftWheel& wheel = side == Side::left ? left_ : right_; wheel.shape)
        parts.radius_m[side] = *wheel.shape->radius_m;
    parts.chassis_mass_kg = chassis_.mass_kg;
    parts.chassis_yaw_inertia_kg_m2 = chassis_.inertia_kg_m2(2, 2);
    parts.center_of_mass_offset_m = (chassis_.center_m - middle_m_).dot(forward_);
    parts.mass_kg = chassis_.mass_kg + left_.body.mass_kg + right_.body.mass_kg;
    return parts;
  }

  RobotDraft draft() {
    draft_.name = mechanism_.name;
    draft_.notes = mechanism_.notes;
    state_geometry();
    state_masses();
    state_friction();
    state_limits();
    state_footprint();
    return std::move(draft_);
  }

 private:
  static bool names(const Names& list, const std::string& name) {
    return std::ranges::find(list, name) != list.end();
  }

  std::pair<const MechanismJoint*, const MechanismJoint*> drive_joints(const Names& wheels) const {
    if (!wheels.empty()) return {joint_named(wheels[0]), joint_named(wheels[1])};
    if (mechanism_.left.size() == 1 && mechanism_.right.size() == 1)
      return {joint_named(mechanism_.left.front()), joint_named(mechanism_.right.front())};
    std::vector<const MechanismJoint*> driven;
    for (const MechanismJoint& joint : mechanism_.joints)
      if (joint.is_driven && joint.turns) driven.push_back(&joint);
    if (!mechanism_.left.empty() || !mechanism_.right.empty() || driven.size() != 2) {
      const std::string plugin = text_of_list(mechanism_.left) + " and " + text_of_list(mechanism_.right);
      refuse(mechanism_,
             !mechanism_.left.empty() ? "a drive plugin with the wheels " + plugin
             : driven.empty()
                 ? "no drive plugin, transmission or actuator that names two drive wheels"
                 : std::to_string(driven.size()) + " driven joints: " +
                       text_of_list(driven, [](const MechanismJoint* joint) { return joint->name; }),
             "--wheels LEFT,RIGHT with two of: " + turning_names(),
             mechanism_.notes.empty()
                 ? "the model has two driven wheels; others count as parts of the chassis"
                 : mechanism_.notes.front());
    }
    if (driven[0]->place_m.y() < driven[1]->place_m.y()) std::swap(driven[0], driven[1]);
    return {driven[0], driven[1]};
  }

  std::string turning_names() const {
    std::string list;
    for (const MechanismJoint& joint : mechanism_.joints)
      if (joint.turns) append_item(list, joint.name);
    return list.empty() ? "(no joint turns)" : list;
  }

  const MechanismJoint* joint_named(const std::string& name) const {
    for (const MechanismJoint& joint : mechanism_.joints)
      if (joint.turns && (joint.name == name || joint.child == name)) return &joint;
    refuse(mechanism_, "no joint " + name + " that turns", "one of: " + turning_names(), "");
  }

  DraftWheel wheel_at(const MechanismJoint& joint) const {
    DraftWheel wheel{.joint = &joint, .links = {joint.child}};
    for (std::size_t i = 0; i < wheel.links.size(); ++i)
      for (const MechanismJoint& below : mechanism_.joints)
        if (below.fixed && below.parent == wheel.links[i] && !names(wheel.links, below.child))
          wheel.links.push_back(below.child);
    std::vector<const MechanismLink*> parts;
    for (const MechanismLink& link : mechanism_.links) {
      if (!names(wheel.links, link.name)) continue;
      parts.push_back(&link);
      wheel.body.has_mass = wheel.body.has_mass || link.has_mass;
      if (link.radius_m && !wheel.shape) wheel.shape = &link;
    }
    const bool has_mass = wheel.body.has_mass;
    wheel.body = combined(parts);
    wheel.body.has_mass = has_mass;
    // The contact lies below the wheel's shape, which may sit beside its joint.
    wheel.contact_m = joint.place_m;
    if (wheel.shape)
      wheel.contact_m += joint.axis * joint.axis.dot(wheel.shape->shape_center_m - joint.place_m);
    return wheel;
  }

  std::string of_both(const std::string& what) const {
    return left_.joint->place + ": " + what + " " + left_.joint->child + " and " + right_.joint->child;
  }

  void note_difference(const std::optional<StatedLength>& stated, double used_m, const std::string& what) {
    if (stated && std::abs(stated->value_m / used_m - 1) > kSameLength)
      draft_.notes.push_back(stated->place + " gives " + four_digits(stated->value_m) + " m, " + what + " " +
                             four_digits(used_m) + " m: the latter is used");
  }

  void state_geometry() {
    if (left_.shape && right_.shape) {
      draft_.state("geometry.wheel_radius_m", *left_.shape->radius_m, *right_.shape->radius_m,
                   left_.shape->place + ": collision radius of " + left_.shape->name);
      note_difference(mechanism_.wheel_radius, *left_.shape->radius_m, "the collision shape");
    } else if (mechanism_.wheel_radius) {
      draft_.state("geometry.wheel_radius_m", mechanism_.wheel_radius->value_m,
                   mechanism_.wheel_radius->place);
    }
    const double half_track_m = 0.5 * (left_.contact_m - right_.contact_m).norm();
    draft_.state("geometry.half_track_m", half_track_m, of_both("half the distance between"));
    note_difference(mechanism_.separation, 2 * half_track_m, "the distance between the wheels is");
    const double aside_m = (chassis_.center_m - middle_m_).dot(left_is_y_);
    if (chassis_.mass_kg > 0 && std::abs(aside_m) > kSameLength * half_track_m)
      draft_.notes.push_back("the chassis' center of mass is " + four_digits(aside_m) +
                             " m left of the middle: the model has it in the middle");
  }

  void state_masses() {
    const std::string parts = counted(chassis_links_.size(), "link") + " without the drive wheels";
    if (chassis_.mass_kg > 0) {
      const std::string from = file_name() + ": " + parts;
      draft_.state("geometry.center_of_mass_offset_m", (chassis_.center_m - middle_m_).dot(forward_),
                   from + ", center of mass");
      draft_.state("inertia.chassis_mass_kg", chassis_.mass_kg, from + ", sum of masses");
      draft_.state("inertia.chassis_yaw_inertia_kg_m2", chassis_.inertia_kg_m2(2, 2),
                   from + ", parallel axes to their center of mass");
    }
    for (const MechanismLink* link : chassis_links_)
      if (!link->has_mass && !link->outline_m.empty())
        draft_.notes.push_back(link->place + ": " + link->name + " has a shape and no mass");
    draft_.values.push_back({"inertia.payload_yaw_inertia_m2", "0.02",
                             "ASSUMED: a crate of 0.35 m; a model says nothing of payloads"});
    if (!left_.body.has_mass || !right_.body.has_mass) return;
    draft_.state("inertia.wheel_mass_kg", mean(left_.body.mass_kg, right_.body.mass_kg), of_both("mass of"));
    draft_.state("inertia.wheel_axle_inertia_kg_m2",
                 mean(left_.axle_inertia_kg_m2(), right_.axle_inertia_kg_m2()),
                 of_both(left_.joint->rotor_inertia_kg_m2 > 0
                             ? "inertia about the axle, with the joint's armature, of"
                             : "inertia about the axle, without a rotor's (rotor * gear_ratio^2), of"));
    draft_.state("inertia.wheel_diameter_inertia_kg_m2",
                 mean(left_.diameter_inertia_kg_m2(), right_.diameter_inertia_kg_m2()),
                 of_both("inertia about a diameter of"));
  }

  void state_friction() {
    const auto state = [&](const char* key, double MechanismJoint::*field, const char* what) {
      if (left_.joint->*field > 0 && right_.joint->*field > 0)
        draft_.state(key, left_.joint->*field, right_.joint->*field, of_both(what));
    };
    state("motor.viscous_friction_Nm_s_rad", &MechanismJoint::damping_Nm_s_rad, "damping of the joints to");
    state("motor.friction_torque_Nm", &MechanismJoint::friction_Nm, "dry friction of the joints to");
  }

  void state_limits() {
    for (const auto& [key, stated] : mechanism_.limits) draft_.state(key, stated.value_m, stated.place);
    const auto radius =
        std::ranges::find(draft_.values, std::string("geometry.wheel_radius_m"), &DraftValue::key);
    if (!left_.joint->speed_rad_s || !right_.joint->speed_rad_s || radius == draft_.values.end()) return;
    const double radius_m = left_.shape ? *left_.shape->radius_m : mechanism_.wheel_radius->value_m;
    const double speed_m_s = radius_m * std::min(*left_.joint->speed_rad_s, *right_.joint->speed_rad_s);
    if (!(speed_m_s > 0)) return;
    RobotDraft joints;
    joints.state("limits.speed_m_s", speed_m_s, of_both("wheel radius * speed limit of the joints to"));
    add_draft(draft_, joints);
  }

  void state_footprint() {
    std::vector<Eigen::Vector2d> points;
    for (const MechanismLink& link : mechanism_.links) {
      if (link.has_mesh) {
        draft_.notes.push_back(link.place + ": a collision shape of " + link.name +
                               " is not read (mesh or plane): footprint is left out");
        return;
      }
      for (const Eigen::Vector3d& point : link.outline_m)
        points.emplace_back((point - middle_m_).dot(forward_), (point - middle_m_).dot(left_is_y_));
    }
    const std::vector<Eigen::Vector2d> hull = hull_of(std::move(points));
    if (hull.size() < 3) return;
    const std::string corners = text_of_list(hull, [](const Eigen::Vector2d& corner) {
      return "[" + significant_text(corner.x()) + ", " + significant_text(corner.y()) + "]";
    });
    draft_.values.push_back({"footprint.polygon_m", "[" + corners + "]",
                             file_name() + ": convex hull of all collision shapes, seen from above"});
  }

  /// Counter-clockwise, without points on its edges (monotone chain).
  static std::vector<Eigen::Vector2d> hull_of(std::vector<Eigen::Vector2d> points) {
    const auto less = [](const auto& a, const auto& b) {
      return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
    };
    std::ranges::sort(points, less);
    const auto is_left = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
      return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) > 1e-9;
    };
    std::vector<Eigen::Vector2d> hull;
    for (const int pass : {0, 1}) {
      const std::size_t least = hull.size() + 1;
      for (const Eigen::Vector2d& point : points) {
        while (hull.size() > least && !is_left(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
        hull.push_back(point);
      }
      if (!hull.empty()) hull.pop_back();
      if (pass == 0) std::ranges::reverse(points);
    }
    return hull;
  }

  static double mean(double a, double b) { return 0.5 * (a + b); }
  std::string file_name() const { return mechanism_.file.substr(mechanism_.file.rfind('/') + 1); }

  const Mechanism& mechanism_;
  DraftWheel left_{}, right_{};
  Eigen::Vector3d left_is_y_{}, forward_{}, middle_m_{};
  std::vector<const MechanismLink*> chassis_links_{};
  MechanismLink chassis_{};
  RobotDraft draft_{};
};

}  // namespace

DriveParts drive_parts_of(const Mechanism& mechanism, const std::vector<std::string>& wheels) {
  return DraftOfMechanism(mechanism, wheels).parts();
}

RobotDraft draft_of(const Mechanism& mechanism, const std::vector<std::string>& wheels) {
  return DraftOfMechanism(mechanism, wheels).draft();
}

}  // namespace joulepath
