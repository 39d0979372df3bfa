#include "extensions/simulators/plant_model.hpp"

#include <map>

#include "extensions/simulators/xml_file.hpp"

namespace joulepath {
namespace {

constexpr double kMillimeter_m = 1e-3;

/// A coordinate by its new or its old name.
double coordinate_m(const XmlElement& point, const char* name, const char* old_name) {
  const auto value = point.number_at(name);
  const auto old = value ? value : point.number_at(old_name);
  if (!old) point.fail("no " + std::string(name), "a point with positionX and positionY in millimetres");
  return kMillimeter_m * *old;
}

}  // namespace

bool is_plant_model(const std::string& file) {
  if (!is_xml(file)) return false;
  const XmlFile xml(file);
  return xml.root().name() == "model" && xml.root().find("point");
}

ForeignGraph read_plant_model(const std::string& file) {
  const XmlFile xml(file);
  ForeignGraph graph;
  std::map<std::string, std::size_t> index_of;
  for (const XmlElement& point : xml.root().children("point")) {
    if (!index_of.emplace(point.required("name"), graph.nodes.size()).second)
      point.fail("a name that another point has", "a name of its own");
    graph.nodes.push_back({point.required("name"), coordinate_m(point, "positionX", "xPosition"),
                           coordinate_m(point, "positionY", "yPosition")});
  }
  std::size_t locked = 0, reversible = 0;
  for (const XmlElement& path : xml.root().children("path")) {
    const auto end = [&](const char* name) {
      const auto found = index_of.find(path.required(name));
      if (found == index_of.end()) path.fail("the point " + path.required(name), "a point of this model");
      return found->second;
    };
    if (path.attribute("locked") == "true") {
      ++locked;
      continue;
    }
    const double forward_m_s = kMillimeter_m * path.number_at("maxVelocity").value_or(0);
    if (path.number_at("maxReverseVelocity").value_or(0) > 0) ++reversible;
    if (forward_m_s > 0)
      graph.edges.push_back(
          {path.required("name"), end("sourcePoint"), end("destinationPoint"), forward_m_s});
  }
  if (locked > 0) graph.notes.push_back(std::to_string(locked) + " locked paths: left out");
  if (reversible > 0)
    graph.notes.push_back(std::to_string(reversible) +
                          " paths for driving backward (maxReverseVelocity): not read");
  graph.notes.push_back("lengths, locations and blocks: not read; paths are straight");
  return graph;
}

}  // namespace joulepath
