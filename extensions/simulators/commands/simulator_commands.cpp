#include <iostream>
#include <utility>

#include "app/program_parts.hpp"
#include "extensions/simulators/model_export.hpp"
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
  parts.export_tasks.insert(parts.export_tasks.end(), {make_mjcf_task, make_sdf_task, make_urdf_task});
}

}  // namespace joulepath
