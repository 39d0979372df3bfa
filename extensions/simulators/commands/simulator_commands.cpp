#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/command_line.hpp"
#include "app/program_parts.hpp"
#include "extensions/simulators/model_export.hpp"
#include "extensions/simulators/proposed_effect.hpp"
#include "extensions/simulators/simulator_patch.hpp"
#include "model/effects/effect_label.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

class ModelTask : public ExportTask {
 public:
  ModelTask(const std::string& format, const std::string& says)
      : ExportTask(format, says,
                   "robot.yaml --to " + format + " --out robot." + (format == "mjcf" ? "xml" : format)) {}
  void declare(CommandLine&) override {}

  int run(const ExportArguments& arguments) override {
    refuse_plan_options(arguments.source);
    const Robot robot = read_robot(arguments.source.file);
    const double payload_kg = arguments.source.payload_kg.value_or(0.0);
    check_payload(payload_kg, robot, arguments.source.file, {{"--payload", 0, 0}, ""});
    const ModelExport model = model_export(robot, payload_kg, name());
    const std::vector<ExportFile> files{{arguments.out, model.text}};
    write_export_files(files, arguments.common);
    if (arguments.common.quiet) return kDone;
    for (const std::string& lost : model.lost) std::cerr << "not in the model: " << lost << "\n";
    tell_export_files(files);
    return kDone;
  }

 private:
  void refuse_plan_options(const MissionSource& source) const {
    for (const auto& [option, given] : {std::pair{"--robot", !source.robot_file.empty()},
                                        {"--map", !source.map_file.empty()},
                                        {"--time", source.duration_s.has_value()},
                                        {"--tolerance", source.tolerance_m.has_value()}})
      if (given)
        throw ConfigError({{option, 0, 0},
                           "",
                           "a value together with --to " + name(),
                           "no such option",
                           "a model is written of a robot file; nothing is planned"});
  }
};

/// The user's own simulator with the effects that the diagnosis named.
class PatchPart : public DiagnosisPart {
 public:
  std::string example() const override { return "dataset.yaml --out out --simulator-model robot.xml"; }

  void declare(CommandLine& line) override {
    line.option("--simulator-model", file_,
                "model of your simulator (URDF, SDF, MJCF): the named effects are added to a copy");
    line.option("--wheels", wheels_,
                "with --simulator-model: the joints of the left and the right drive wheel")
        .comma_separated();
  }

  void prepare() override {
    const auto refuse_wheels = [](std::string found, std::string accepted) {
      throw ConfigError({{"--wheels", 0, 0},
                         "",
                         std::move(found),
                         std::move(accepted),
                         "the wheels are joints of the file that --simulator-model names"});
    };
    if (file_.empty() && !wheels_.empty())
      refuse_wheels("a value without --simulator-model", "a value only together with --simulator-model");
    if (!wheels_.empty() && wheels_.size() != 2)
      refuse_wheels(std::to_string(wheels_.size()) + " names", "two: LEFT,RIGHT");
    if (!file_.empty()) static_cast<void>(simulator_patch(file_, {}, wheels_));
  }

  std::string asked_by() const override {
    return !file_.empty() ? "--simulator-model" : !wheels_.empty() ? "--wheels" : "";
  }

  std::vector<std::string> files() const override {
    std::vector<std::string> names{"simulator_patch.diff", "simulator_patch.json"};
    if (!file_.empty()) names.push_back(patched());
    return names;
  }

  void write(const Diagnosis& diagnosis, OutputDirectory& out, std::ostream& summary) override {
    if (file_.empty()) return;
    std::vector<EffectSetting> effects;
    std::vector<SimulatorPatch::Remainder> withheld;
    for (const Cause& cause : diagnosis.causes)
      if (const auto effect = proposed_effect(cause, diagnosis))
        effects.push_back(*effect);
      else
        withheld.push_back({effect_label(cause.effect),
                            "not proposed: the gap of the runs that judge it does not shrink with it"});
    SimulatorPatch patch = simulator_patch(file_, effects, wheels_);
    patch.not_in_model.insert(patch.not_in_model.end(), withheld.begin(), withheld.end());
    nlohmann::json json{{"model", file_},
                        {"patched", patched()},
                        {"changes", nlohmann::json::array()},
                        {"not_in_model", nlohmann::json::array()}};
    for (const auto& [effect, what] : patch.changes) {
      json["changes"].push_back({{"effect", effect}, {"what", what}});
      summary << "simulator's model, " << effect << ": " << what << '\n';
    }
    for (const auto& [effect, what] : patch.not_in_model) {
      json["not_in_model"].push_back({{"effect", effect}, {"what", what}});
      summary << "not in the simulator's model: " << effect << ", " << what << '\n';
    }
    if (patch.changes.empty()) summary << "the simulator's model stays as it is\n";
    if (diagnosis.simulator.runs == 0 && !effects.empty())
      summary
          << "the effects are differences to the robot file: the patch holds where the model says the same\n";
    out.write(patched(), patch.text);
    out.write("simulator_patch.diff", patch.diff);
    out.write("simulator_patch.json", json.dump(2) + "\n");
  }

 private:
  std::string patched() const {
    const std::filesystem::path path(file_);
    return path.stem().string() + "_patched" + path.extension().string();
  }

  std::string file_{};
  std::vector<std::string> wheels_{};
};

std::unique_ptr<DiagnosisPart> make_patch_part() { return std::make_unique<PatchPart>(); }
std::unique_ptr<ExportTask> make_mjcf_task() {
  return std::make_unique<ModelTask>("mjcf", "a robot file as a model of MuJoCo, its motors as actuators");
}
std::unique_ptr<ExportTask> make_sdf_task() {
  return std::make_unique<ModelTask>("sdf", "a robot file as a model of Gazebo, with its drive plugin");
}
std::unique_ptr<ExportTask> make_urdf_task() {
  return std::make_unique<ModelTask>("urdf", "a robot file as a URDF, with Gazebo's drive plugin");
}

}  // namespace

void add_simulators_commands(ProgramParts& parts) {
  parts.diagnosis_parts.push_back(make_patch_part);
  parts.export_tasks.insert(parts.export_tasks.end(), {make_mjcf_task, make_sdf_task, make_urdf_task});
}

}  // namespace joulepath
