#include "extensions/simulators/mechanism_draft.hpp"
#include "extensions/simulators/model_files.hpp"
#include "extensions/simulators/plant_model.hpp"
#include "scenarios/registry.hpp"

namespace joulepath {

namespace {

/// Other XML files get the reader's error, too.
bool is_robot_model(const std::string& file) { return is_xml(file) && !is_plant_model(file); }

}  // namespace

void add_simulators(Registry& registry) {
  registry.robots.push_back({.says = "a URDF, SDF or MJCF model",
                             .recognizes_file = is_robot_model,
                             .read = [](const std::string& file, const std::vector<std::string>& wheels) {
                               return draft_of(read_mechanism(XmlFile(file).root()), wheels);
                             }});
  registry.graphs.push_back({"a plant model of openTCS", is_plant_model, read_plant_model});
}

}  // namespace joulepath
