#include "extensions/nav2/foreign_graphs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "model/text_of_list.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"

namespace joulepath {
namespace {

constexpr long kMostNodeId = 2'000'000'000;  ///< route servers store ids in 32 bits

bool has_list(const Node& node, std::string_view key) {
  const auto found = node.kind() == Value::Kind::map ? node.find(key) : std::nullopt;
  return found && found->kind() == Value::Kind::list;
}

double coordinate_in_m(const Node& node, double unit_m = 1.0) {
  const double value_m = unit_m * node.number();
  if (!(std::abs(value_m) <= kFarthest_m)) node.fail("at most 1e6 m from the origin");
  return value_m;
}

/// 0 is no limit.
std::optional<double> speed_limit_in_m_s(const Node& node) {
  const double limit_m_s = node.number();
  if (limit_m_s == 0) return std::nullopt;
  if (!(limit_m_s >= 1e-3 && limit_m_s <= 100)) node.fail("0 (no limit) or from 0.001 to 100 m/s");
  return limit_m_s;
}

/// LIF of VDMA: layouts with nodes and edges, named by texts.
ForeignGraph read_lif(const Node& root) {
  ForeignGraph graph;
  std::vector<Node> drawn;
  for (const Node& layout : root["layouts"].items())
    if (has_list(layout, "nodes") && !layout["nodes"].items().empty()) drawn.push_back(layout);
  if (drawn.size() != 1)
    root["layouts"].fail_found(std::to_string(drawn.size()) + " layouts with nodes", "one",
                               "a robot's map is one floor: leave the others out");
  std::map<std::string, std::size_t> index_of;
  for (const Node& node : drawn.front()["nodes"].items()) {
    const Node id = node["nodeId"], position = node["nodePosition"];
    if (!index_of.emplace(id.text(), graph.nodes.size()).second) id.fail("an id that no other node has");
    graph.nodes.push_back({id.text(), coordinate_in_m(position["x"]), coordinate_in_m(position["y"])});
  }
  const auto index = [&](const Node& id) {
    const auto found = index_of.find(id.text());
    if (found == index_of.end()) id.fail("the nodeId of a node of this layout");
    return found->second;
  };
  std::size_t bent = 0;
  if (has_list(drawn.front(), "edges"))
    for (const Node& edge : drawn.front()["edges"].items()) {
      ForeignGraph::Edge made{edge["edgeId"].text(), index(edge["startNodeId"]), index(edge["endNodeId"])};
      if (has_list(edge, "vehicleTypeEdgeProperties"))
        for (const Node& vehicle : edge["vehicleTypeEdgeProperties"].items()) {
          const auto stated = vehicle.find("maxSpeed");
          if (const auto speed_m_s = stated ? speed_limit_in_m_s(*stated) : std::nullopt)
            made.speed_limit_m_s = std::min(*speed_m_s, made.speed_limit_m_s.value_or(*speed_m_s));
          if (vehicle.has("trajectory")) ++bent;
        }
      graph.edges.push_back(std::move(made));
    }
  if (bent > 0)
    graph.notes.push_back(std::to_string(bent) + " trajectories of edges: not read, edges are straight");
  graph.notes.push_back(
      "stations, actions and vehicle types: not read; maxSpeed is the least of all vehicle types");
  return graph;
}

/// A parameter of Open-RMF's traffic editor: [type, value], or the value alone in navigation graphs.
std::optional<Node> rmf_parameter(const Node& item, std::size_t at, std::string_view key) {
  const std::vector<Node> parts = item.items();
  if (parts.size() <= at || parts[at].kind() != Value::Kind::map) return std::nullopt;
  const auto found = parts[at].find(key);
  if (!found || found->kind() != Value::Kind::list) return found;
  const std::vector<Node> typed = found->items();
  if (typed.size() != 2) found->fail("[type, value]");
  return typed[1];
}

/// The vertices of a level: at least [x, y].
std::vector<Node> vertices_of(const Node& level) {
  std::vector<Node> vertices = level["vertices"].items();
  for (const Node& vertex : vertices)
    if (vertex.items().size() < 2) vertex.fail("[x, y, ...]");
  return vertices;
}

/// Meters per pixel of a level's drawing, by its measurements.
double scale_of(const Node& level, const std::vector<Node>& vertices) {
  double sum = 0;
  std::size_t count = 0;
  if (has_list(level, "measurements"))
    for (const Node& measurement : level["measurements"].items()) {
      const std::vector<Node> ends = measurement.items();
      const auto distance = rmf_parameter(measurement, 2, "distance");
      if (ends.size() < 3 || !distance) measurement.fail("[vertex, vertex, {distance: [3, metres]}]");
      const auto corner = [&](const Node& end) {
        const long i = end.integer();
        if (i < 0 || static_cast<std::size_t>(i) >= vertices.size()) end.fail("the number of a vertex");
        return vertices[static_cast<std::size_t>(i)].items();
      };
      const std::vector<Node> a = corner(ends[0]), b = corner(ends[1]);
      const double pixels = std::hypot(a[0].number() - b[0].number(), a[1].number() - b[1].number());
      if (!(pixels > 0 && distance->number() > 0)) measurement.fail("two places and a distance above 0");
      sum += distance->number() / pixels;
      ++count;
    }
  if (count == 0)
    level.fail_found("no measurements", "measurements: [[vertex, vertex, {distance: [3, metres]}]]",
                     "without them the drawing's pixels have no length");
  return sum / static_cast<double>(count);
}

/// A building of the traffic editor (vertices x, y, z, name) or a navigation graph (x, y and a map).
ForeignGraph read_rmf(const Node& root) {
  ForeignGraph graph;
  std::vector<std::pair<std::string, Node>> drawn;
  for (const auto& [name, level] : root["levels"].entries())
    if (has_list(level, "lanes") && !level["lanes"].items().empty()) drawn.emplace_back(name, level);
  if (drawn.size() != 1)
    root["levels"].fail_found(std::to_string(drawn.size()) + " levels with lanes" +
                                  (drawn.empty() ? "" : ": ") +
                                  text_of_list(drawn, [](const auto& level) { return level.first; }),
                              "one", "a robot's map is one level: leave the others out");
  const Node& level = drawn.front().second;
  const std::vector<Node> vertices = vertices_of(level);
  const std::string system = root.text_or("coordinate_system", "reference_image");
  if (system == "wgs84")
    root["coordinate_system"].fail("reference_image or cartesian_meters",
                                   "degrees are no metres: project them");
  const bool is_building = !vertices.empty() && vertices.front().items().size() > 3;
  const bool in_pixels = is_building && system != "cartesian_meters";
  const double unit_m = in_pixels ? scale_of(level, vertices) : 1.0;
  for (const Node& vertex : vertices) {
    const std::vector<Node> parts = vertex.items();
    std::string name;
    if (is_building && parts.size() > 3) name = parts[3].text();
    if (!is_building && parts.size() > 2 && parts[2].kind() == Value::Kind::map)
      name = parts[2].text_or("name", "");
    graph.nodes.push_back(
        {name, coordinate_in_m(parts[0], unit_m), coordinate_in_m(parts[1], in_pixels ? -unit_m : unit_m)});
  }
  std::set<std::string> graphs;
  for (const Node& lane : level["lanes"].items()) {
    const std::vector<Node> parts = lane.items();
    if (parts.size() < 2) lane.fail("[from, to, {...}]");
    const auto end = [&](const Node& number) {
      const long i = number.integer();
      if (i < 0 || static_cast<std::size_t>(i) >= graph.nodes.size()) number.fail("the number of a vertex");
      return static_cast<std::size_t>(i);
    };
    ForeignGraph::Edge edge{"", end(parts[0]), end(parts[1])};
    if (const auto speed = rmf_parameter(lane, 2, "speed_limit"))
      edge.speed_limit_m_s = speed_limit_in_m_s(*speed);
    const auto number = rmf_parameter(lane, 2, "graph_idx");
    graphs.insert(number ? number->text() : "0");
    graph.edges.push_back(edge);
    const auto both = rmf_parameter(lane, 2, is_building ? "bidirectional" : "is_bidirectional");
    if (!both || !both->boolean()) continue;
    std::swap(edge.start, edge.end);
    graph.edges.push_back(std::move(edge));
  }
  if (graphs.size() > 1)
    level["lanes"].fail_found(
        "lanes of the graphs " + text_of_list(graphs), "lanes of one graph",
        "rmf_building_map_tools writes one navigation graph for each: nav_graphs/0.yaml");
  graph.notes.push_back("doors, lifts, mutexes and orientations of lanes: not read");
  return graph;
}

/// Ids that are numbers stay; otherwise nodes are numbered.
std::vector<long> ids_of(const ForeignGraph& graph) {
  std::vector<long> ids;
  std::set<long> seen;
  for (const ForeignGraph::Node& node : graph.nodes) {
    const bool digits = !node.name.empty() && node.name.size() < 10 &&
                        node.name.find_first_not_of("0123456789") == std::string::npos;
    if (digits && std::stol(node.name) <= kMostNodeId && seen.insert(std::stol(node.name)).second)
      ids.push_back(std::stol(node.name));
  }
  if (ids.size() == graph.nodes.size()) return ids;
  ids.clear();
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) ids.push_back(static_cast<long>(i));
  return ids;
}

std::string geojson_of(const ForeignGraph& graph) {
  using Object = nlohmann::ordered_json;
  Object file{{"type", "FeatureCollection"}, {"features", Object::array()}};
  const std::vector<long> ids = ids_of(graph);
  const auto add = [&](Object properties, const std::string& name, Object geometry) {
    if (!name.empty()) properties["metadata"]["name"] = name;
    file["features"].push_back({{"type", "Feature"}, {"properties", properties}, {"geometry", geometry}});
  };
  for (std::size_t i = 0; i < graph.nodes.size(); ++i)
    add({{"id", ids[i]}}, graph.nodes[i].name,
        {{"type", "Point"}, {"coordinates", {graph.nodes[i].x_m, graph.nodes[i].y_m}}});
  long id = ids.empty() ? 0 : *std::ranges::max_element(ids) + 1;
  for (const ForeignGraph::Edge& edge : graph.edges) {
    const auto &a = graph.nodes[edge.start], &b = graph.nodes[edge.end];
    Object properties{{"id", id++}, {"startid", ids[edge.start]}, {"endid", ids[edge.end]}};
    if (edge.speed_limit_m_s) properties["metadata"]["abs_speed_limit"] = *edge.speed_limit_m_s;
    add(std::move(properties), edge.name,
        {{"type", "MultiLineString"}, {"coordinates", {{{a.x_m, a.y_m}, {b.x_m, b.y_m}}}}});
  }
  return file.dump(1, ' ', false, Object::error_handler_t::replace) + "\n";
}

bool is_lif(const Node& root) { return has_list(root, "layouts"); }
bool is_rmf(const Node& root) {
  const auto levels = root.kind() == Value::Kind::map ? root.find("levels") : std::nullopt;
  return levels && levels->kind() == Value::Kind::map;
}

}  // namespace

bool is_foreign_graph(const Document& document) { return is_lif(document.root()) || is_rmf(document.root()); }

bool is_graph_of_extension(const std::string& file) {
  return std::ranges::any_of(registry().graphs,
                             [&](const GraphSource& source) { return source.recognizes(file); });
}

std::string geojson_text(const std::string& file, const NamedBy& named_by, std::vector<std::string>* notes) {
  const auto written = [&](const ForeignGraph& graph) {
    if (notes != nullptr) notes->insert(notes->end(), graph.notes.begin(), graph.notes.end());
    return geojson_of(graph);
  };
  for (const GraphSource& source : registry().graphs)
    if (source.recognizes(file)) return written(source.read(file));
  const Document document = Document::load(file, named_by);
  if (is_lif(document.root())) return written(read_lif(document.root()));
  if (is_rmf(document.root())) return written(read_rmf(document.root()));
  return read_text_file(file, named_by);
}

}  // namespace joulepath
