#include "model/effects/effects_document.hpp"

#include <sstream>

#include "model/effects/catalog.hpp"

namespace joulepath {
namespace {

std::string cell(std::string_view text) {  // a pipe ends a table's cell
  std::string out;
  for (char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

const char* const kHead = R"(# Effects
For those who add an effect to a robot file or a simulation, or who look up a name of a diagnosis: the law, the parameters
and the validity of each effect, and its counterparts in Gazebo and MuJoCo.

An effect is a deviation of a robot from its file. Planner, simulator and diagnosis use the same catalog. Add an effect
to a robot file's `effects:`, or to a simulation alone (`joulepath simulate --effect NAME:PARAMETER=VALUE,...`).
`joulepath effects --markdown` writes this page from the catalog in `model/effects/`; a test compares both.

In a robot file an effect may have a `probability`, which `diagnose` writes; the plan and its energy intervals hold the whole
effect all the same. `plan --confidence` draws robots that lack the effect with the remaining probability, each effect
independently of the others.

Resistances oppose the motion of the wheel or of the robot. N = m g / 2 is the load on a wheel, with wheels and payload.
"Change" and "error" are relative to the robot file. `stage` is the place of an effect in the chain from body to battery:
parameters (a constant differs), body (force and moment on the robot), wheel (torque at the wheel's shaft), gear, contact
(between wheel and floor), winding, driver, supply, instrument (the log only, without influence on planning and motion).

## Counterparts in other simulators
Settings that give a simulated robot the same effect; "none" means that it needs a plugin of your own.

| effect | Gazebo (SDFormat) | MuJoCo (MJCF) |
|---|---|---|
)";

std::string side_note(const EffectDescription& effect) {
  std::string note;
  if (effect.has_side) note += "| `side` | | left, right | | the wheel or sensor concerned |\n";
  if (effect.has_cells)
    note += "| `cells` | m | | | instead of the edges: a list of [x_min, x_max, y_min, y_max] |\n";
  return note;
}

}  // namespace

std::string effects_markdown() {
  std::ostringstream text;
  text << kHead;
  for (const EffectDescription& effect : effect_catalog())
    text << "| [`" << effect.info.name << "`](#" << effect.info.name << ") | " << cell(effect.info.gazebo)
         << " | " << cell(effect.info.mujoco) << " |\n";
  std::string_view kind;
  for (const EffectDescription& effect : effect_catalog()) {
    if (effect.info.kind != kind) {
      kind = effect.info.kind;
      text << "\n## Kind: " << kind << "\n";
    }
    text << "\n### " << effect.info.name << "\n"
         << "Law: " << effect.info.law << ".  \nStage: " << stage_name(effect.info.stage)
         << ". Valid for: " << effect.info.validity << ".";
    if (effect.info.source != "-") text << " Source: " << effect.info.source << ".";
    text << "\n\n| parameter | unit | accepted | typical | meaning |\n|---|---|---|---|---|\n";
    for (const ParameterDescription& p : effect.parameters)
      text << "| `" << p.name << "` | " << p.unit << " | " << p.min << " to " << p.max << " | " << p.typical
           << " | " << cell(p.meaning) << " |\n";
    text << side_note(effect);
  }
  return text.str();
}

}  // namespace joulepath
