#include "extensions/simulators/simulator_patch.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "extensions/simulators/mechanism_draft.hpp"
#include "extensions/simulators/model_files.hpp"
#include "extensions/simulators/xml_edits.hpp"
#include "model/dynamics.hpp"
#include "model/effects/catalog.hpp"
#include "model/effects/effect_label.hpp"
#include "model/number_text.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

constexpr double kReadsBack = 1e-6;  ///< relative error of a value that was written and read

/// One text of a model: its elements, its values, and changes to it.
class ModelText {
 public:
  ModelText(const std::string& file, const std::string& text, const std::vector<std::string>& wheels)
      : xml_(file, text),
        mechanism_(read_mechanism(xml_.root())),
        parts_(drive_parts_of(mechanism_, wheels)),
        edits_(text) {}

  const DriveParts& parts() const { return parts_; }
  std::string text() const { return edits_.text(); }
  bool is_mjcf() const { return xml_.root().name() == "mujoco"; }

  /// `quantity`: damping or friction of a joint.
  void set_joint(Side side, const std::string& quantity, double value) {
    const XmlElement joint = xml_.element(parts_.joint[side]->element);
    const std::string number = number_text(value);
    if (is_mjcf())
      return edits_.set_attribute(joint.index(), quantity == "friction" ? "frictionloss" : quantity, number);
    if (is_sdf()) {
      const auto axis = joint.find("axis");
      if (axis) set_below(*axis, {"dynamics", quantity}, number);
      return;
    }
    if (const auto dynamics = joint.find("dynamics"))
      edits_.set_attribute(dynamics->index(), quantity, number);
    else
      edits_.insert_child(joint.index(), "<dynamics " + quantity + "=\"" + number + "\"/>");
  }

  void set_radius(Side side, double factor) {
    for (const MechanismLink* link : parts_.links[side])
      for (const XmlElement& shape : shapes(xml_.element(link->element))) scale_radius(shape, factor);
  }

  void add_yaw_inertia(double change_kg_m2) {
    const auto inertial = inertial_of_chassis();
    if (!inertial) return;
    if (is_mjcf())
      return add_to_list(*inertial, inertial->attribute("diaginertia") ? "diaginertia" : "fullinertia", 2,
                         change_kg_m2);
    const auto inertia = inertial->find("inertia");
    if (!inertia) return;
    if (!is_sdf()) return add_to_list(*inertia, "izz", 0, change_kg_m2);
    if (const auto izz = inertia->find("izz"))
      edits_.set_text(izz->index(), number_text(izz->number(izz->text()) + change_kg_m2));
  }

  /// Along the x axis of the heaviest link.
  void move_center_of_mass(double change_m) {
    const auto inertial = inertial_of_chassis();
    if (!inertial) return;
    if (is_mjcf()) return add_to_list(*inertial, "pos", 0, change_m);
    if (is_sdf()) {
      const auto pose = inertial->find("pose");
      if (!pose)
        return edits_.insert_child(inertial->index(), "<pose>" + number_text(change_m) + " 0 0 0 0 0</pose>");
      std::vector<double> numbers = pose->numbers(pose->text(), 0);
      if (numbers.empty()) numbers.assign(6, 0.0);
      return edits_.set_text(pose->index(), list_text(std::move(numbers), 0, change_m));
    }
    const auto origin = inertial->find("origin");
    if (!origin)
      return edits_.insert_child(inertial->index(), "<origin xyz=\"" + number_text(change_m) + " 0 0\"/>");
    if (origin->attribute("xyz")) return add_to_list(*origin, "xyz", 0, change_m);
    edits_.set_attribute(origin->index(), "xyz", number_text(change_m) + " 0 0");
  }

  /// Scales torque per control and torque per speed of the actuators of MJCF whose control is a voltage:
  /// gainprm = K/R, biasprm = 0 0 -K Kv/R. The number of actuators.
  int scale_actuators(double gain, double bias) {
    int count = 0;
    for (const XmlElement& actuators : xml_.root().children("actuator"))
      for (const XmlElement& actuator : actuators.children("general")) {
        const auto joint = actuator.attribute("joint"), gains = actuator.attribute("gainprm"),
                   biases = actuator.attribute("biasprm");
        if (!joint || !gains || !biases || !drives(*joint)) continue;
        std::vector<double> g = actuator.numbers(*gains, 0), b = actuator.numbers(*biases, 0);
        if (g.empty() || b.size() < 3 || b[0] != 0 || b[1] != 0 || !(b[2] < 0)) continue;
        edits_.set_attribute(actuator.index(), "gainprm", list_text(g, 0, (gain - 1) * g[0]));
        edits_.set_attribute(actuator.index(), "biasprm", list_text(b, 2, (bias - 1) * b[2]));
        ++count;
      }
    return count;
  }

  /// Gravity on a floor that rises along a direction of the floor: the floor of the model stays level.
  bool tilt(double grade, double uphill_direction_rad) {
    if (!is_mjcf()) return false;
    const std::vector<XmlElement> options = xml_.root().children("option");
    constexpr double kGravityOfMujoco_m_s2 = 9.81;
    const double along = -kGravityOfMujoco_m_s2 * grade;
    const std::string gravity = number_text(along * std::cos(uphill_direction_rad)) + " " +
                                number_text(along * std::sin(uphill_direction_rad)) + " " +
                                number_text(-kGravityOfMujoco_m_s2);
    if (options.empty())
      edits_.insert_child(xml_.root().index(), "<option gravity=\"" + gravity + "\"/>");
    else if (options.size() > 1 || options.front().attribute("gravity"))
      return false;
    else
      edits_.set_attribute(options.front().index(), "gravity", gravity);
    return true;
  }

 private:
  bool is_sdf() const { return xml_.root().name() == "sdf"; }
  bool drives(const std::string& joint) const {
    return joint == parts_.joint.left->name || joint == parts_.joint.right->name;
  }

  std::optional<XmlElement> inertial_of_chassis() const {
    return parts_.heaviest ? xml_.element(parts_.heaviest->element).find("inertial") : std::nullopt;
  }

  std::vector<XmlElement> shapes(const XmlElement& link) const {
    if (is_mjcf()) {
      std::vector<XmlElement> geoms = link.children("geom");
      std::erase_if(geoms, [](const XmlElement& geom) { return geom.attribute("type") == "box"; });
      return geoms;
    }
    std::vector<XmlElement> found;
    for (const XmlElement& collision : link.children("collision"))
      if (const auto geometry = collision.find("geometry"))
        for (const XmlElement& shape : geometry->children()) found.push_back(shape);
    return found;
  }

  void scale_radius(const XmlElement& shape, double factor) {
    const char* name = is_mjcf() ? "size" : "radius";
    if (const auto text = shape.attribute(name)) {
      std::vector<double> sizes = shape.numbers(*text, 0);
      const double radius_m = sizes.empty() ? 0.0 : sizes[0];
      for (std::size_t i = 0; i < sizes.size(); ++i)  // an ellipsoid has the radius twice
        if (i == 0 || (sizes.size() == 3 && sizes[i] == radius_m)) sizes[i] *= factor;
      edits_.set_attribute(shape.index(), name, list_text(sizes));
    } else if (const auto radius = shape.find(name)) {
      edits_.set_text(radius->index(), number_text(factor * radius->number(radius->text())));
    }
  }

  void add_to_list(const XmlElement& element, const char* attribute, std::size_t at, double change) {
    const auto text = element.attribute(attribute);
    if (!text) return;
    const std::vector<double> values = element.numbers(*text, 0);
    if (at < values.size()) edits_.set_attribute(element.index(), attribute, list_text(values, at, change));
  }

  static std::string list_text(std::vector<double> values, std::size_t at, double change) {
    values[at] += change;
    return list_text(values);
  }
  static std::string list_text(const std::vector<double>& values) {
    std::string text;
    for (const double value : values) text += (text.empty() ? "" : " ") + number_text(value);
    return text;
  }

  /// The text of a descendant; elements that are absent are inserted.
  void set_below(const XmlElement& element, const std::vector<std::string>& names, const std::string& value) {
    std::optional<XmlElement> at = element;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto below = at->find(names[i].c_str());
      if (below) {
        at = below;
        continue;
      }
      std::string child = value;
      for (std::size_t k = names.size(); k-- > i;) {
        child.insert(0, "<" + names[k] + ">");
        child += "</" + names[k] + ">";
      }
      return edits_.insert_child(at->index(), child);
    }
    edits_.set_text(at->index(), value);
  }

  XmlFile xml_;
  Mechanism mechanism_;
  DriveParts parts_;
  XmlEdits edits_;
};

/// A value of the model that an effect changes.
struct Quantity {
  std::string name{};
  double (*of)(const DriveParts&, Side){};
};
const Quantity kFriction{"dry friction of a drive joint (N m)",
                         [](const DriveParts&p, Side side) { return p.joint[side]->friction_Nm; }},
    kDamping{"damping of a drive joint (N m s/rad)",
             [](const DriveParts&p, Side side) { return p.joint[side]->damping_Nm_s_rad; }},
    kRadius{"radius of a drive wheel (m)", [](const DriveParts&p, Side side) { return p.radius_m[side]; }},
    kYawInertia{"yaw inertia of the chassis (kg m2)",
                [](const DriveParts&p, Side) { return p.chassis_yaw_inertia_kg_m2; }},
    kCenter{"center of mass forward of the axle (m)",
            [](const DriveParts&p, Side) { return p.center_of_mass_offset_m; }};

/// What one effect does to a model: a quantity and its change, by an edit.
struct Edit {
  const Quantity* quantity{};  ///< null: nothing reads it back
  Sided<double> change{};
  std::function<bool(ModelText&)> apply{};  ///< false: the file has no place for it
};

double parameter(const EffectSetting& effect, const char* name) {
  const auto found = effect.parameters.find(name);
  return found == effect.parameters.end() ? 0.0 : found->second;
}

Edit joint_edit(const Quantity& quantity, const char* name, const DriveParts& parts, Sided<double> change) {
  return {&quantity, change, [&quantity, name, parts, change](ModelText& model) {
            for (const Side side : kSides)
              if (change[side] != 0) model.set_joint(side, name, quantity.of(parts, side) + change[side]);
            return true;
          }};
}

Edit radius_edit(const DriveParts& parts, Sided<double> factor) {
  const Sided<double> change{(factor.left - 1) * parts.radius_m.left,
                             (factor.right - 1) * parts.radius_m.right};
  return {&kRadius, change, [factor](ModelText& model) {
            for (const Side side : kSides) model.set_radius(side, factor[side]);
            return true;
          }};
}

Edit actuator_edit(double gain, double bias) {
  return {nullptr, {}, [gain, bias](ModelText& model) { return model.scale_actuators(gain, bias) == 2; }};
}

/// How an effect changes a model; nothing where URDF, SDF and MJCF have no such value.
std::optional<Edit> edit_of(const EffectSetting& effect, const DriveParts& parts) {
  const auto value = [&](const char* name) { return parameter(effect, name); };
  const auto both = [](double change) { return Sided<double>{change, change}; };
  const double fraction = value("fraction");
  const std::string& name = effect.name;
  if (name == "coulomb_friction") return joint_edit(kFriction, "friction", parts, both(value("torque_Nm")));
  if (name == "viscous_friction")
    return joint_edit(kDamping, "damping", parts, both(value("coefficient_Nm_s_rad")));
  if (name == "dragging_wheel" && effect.side) {
    Sided<double> change{};
    change[*effect.side] = value("torque_Nm");
    return joint_edit(kFriction, "friction", parts, change);
  }
  if (name == "rolling_resistance") {
    const double force_N = value("coefficient") * 0.5 * parts.mass_kg * kGravity_m_s2;
    return joint_edit(kFriction, "friction", parts,
                      {force_N * parts.radius_m.left, force_N * parts.radius_m.right});
  }
  const bool sees_radii = parts.radius_m.left > 0 && parts.radius_m.right > 0;
  if (name.starts_with("wheel_radius") && !sees_radii) return std::nullopt;
  if (name == "wheel_radius_error") return radius_edit(parts, both(1 + fraction));
  if (name == "wheel_radius_mismatch") return radius_edit(parts, {1 + fraction / 2, 1 - fraction / 2});
  if (name == "yaw_inertia_error") {
    const double change = fraction * parts.chassis_yaw_inertia_kg_m2;
    return Edit{&kYawInertia, both(change),
                [change](ModelText& m) { return m.add_yaw_inertia(change), true; }};
  }
  if (name == "center_of_mass_offset" && parts.heaviest) {
    const double change = value("offset_m"), move = change * parts.chassis_mass_kg / parts.heaviest->mass_kg;
    return Edit{&kCenter, both(change), [move](ModelText& m) { return m.move_center_of_mass(move), true; }};
  }
  if (name == "torque_constant_error") return actuator_edit(1 + fraction, (1 + fraction) * (1 + fraction));
  if (name == "winding_resistance_error") return actuator_edit(1 / (1 + fraction), 1 / (1 + fraction));
  if (name == "floor_slope")
    return Edit{nullptr, {}, [grade = value("grade"), uphill = value("uphill_direction_rad")](ModelText& m) {
                  return m.tilt(grade, uphill);
                }};
  return std::nullopt;
}

std::string values_text(const EffectSetting& effect) {
  std::string text;
  for (const auto& [name, value] : effect.parameters)
    text += (text.empty() ? "" : ", ") + name + " = " + significant_text(value);
  return text;
}

/// What has to be done by hand: the law and where it acts.
std::string by_hand(const EffectSetting& effect, bool is_mjcf) {
  const EffectDescription* known = find_effect(effect.name);
  if (known == nullptr) return values_text(effect);
  const EffectInfo& info = known->info;
  std::string text = values_text(effect) + ". Law: " + std::string(info.law) + ". ";
  if (info.stage == Stage::instrument) return text + "It belongs to the log, not to the simulator.";
  const std::string_view counterpart = is_mjcf ? info.mujoco : info.gazebo;
  if (!counterpart.starts_with("none")) text += "Counterpart: " + std::string(counterpart) + ". ";
  switch (info.stage) {
    case Stage::body:
      return text + "By a plugin: at each step apply the force or moment to the chassis.";
    case Stage::wheel:
    case Stage::gear:
      return text + "By a plugin: at each step apply the torque to each drive joint.";
    case Stage::winding:
    case Stage::driver:
    case Stage::supply:
      return text + "By a plugin: in the motor model between command and torque.";
    default:
      return text + "Change it by hand.";
  }
}

bool agree(double a, double b) {
  return std::abs(a - b) <= kReadsBack * std::max({std::abs(a), std::abs(b), 1e-9});
}

/// What changed, if a model reads back with the intended values; empty otherwise.
std::string read_back(const Edit& edit, const EffectSetting& effect, const DriveParts& before,
                      const DriveParts& after) {
  if (!agree(before.mass_kg, after.mass_kg)) return "";
  if (edit.quantity == nullptr) return values_text(effect);
  Sided<std::string> text;
  for (const Side side : kSides) {
    const double was = edit.quantity->of(before, side), is = edit.quantity->of(after, side);
    const bool may_be_negative = edit.quantity == &kCenter;
    if (!agree(is, was + edit.change[side]) || !(is >= 0 || may_be_negative)) return "";
    if (edit.change[side] != 0) text[side] = significant_text(was) + " to " + significant_text(is);
  }
  if (text.left == text.right) return edit.quantity->name + ": " + text.left;
  std::string sides;
  for (const Side side : kSides)
    if (!text[side].empty()) append_item(sides, side_name(side) + (" " + text[side]));
  return edit.quantity->name + ": " + sides;
}

/// The same for a text that may have become none of a model.
std::string read_back_of(const Edit& edit, const EffectSetting& effect, const ModelText& model,
                         const std::string& file, const std::vector<std::string>& wheels) {
  try {
    return read_back(edit, effect, model.parts(), ModelText(file, model.text(), wheels).parts());
  } catch (const ConfigError&) {
    return "";
  }
}

}  // namespace

SimulatorPatch simulator_patch(const std::string& file, const std::vector<EffectSetting>& effects,
                               const std::vector<std::string>& wheels) {
  const std::string original = read_text_file(file);
  SimulatorPatch patch{.text = original};
  static_cast<void>(ModelText(file, original, wheels));  // throws for what is no such model
  for (const EffectSetting& effect : effects) {
    ModelText model(file, patch.text, wheels);
    const auto edit = edit_of(effect, model.parts());
    const bool changed = edit && edit->apply(model) && model.text() != patch.text;
    const std::string what = changed ? read_back_of(*edit, effect, model, file, wheels) : "";
    if (what.empty()) {
      patch.not_in_model.push_back({effect_label(effect), by_hand(effect, model.is_mjcf())});
      continue;
    }
    patch.text = model.text();
    patch.changes.push_back({effect_label(effect), what});
  }
  patch.diff = unified_diff(original, patch.text, file.substr(file.rfind('/') + 1));
  return patch;
}

}  // namespace joulepath
