#include "extensions/nav2/route_graph_file.hpp"

#include <cmath>
#include <map>

#include "extensions/nav2/foreign_graphs.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/text/schema.hpp"

namespace joulepath {
namespace {

std::array<double, 2> read_point(const Node& node) {
  const auto xy = node.items();
  if (xy.size() < 2) node.fail("[x, y]");
  for (std::size_t i = 0; i < 2; ++i)
    if (std::abs(xy[i].number()) > kFarthest_m) xy[i].fail("at most 1e6 m from the origin");
  return {xy[0].number(), xy[1].number()};
}

/// A limit of speed in an edge's metadata: `abs_speed_limit` in m/s or `speed_limit` in percent, each up to
/// 100.
std::optional<double> read_limit(const Node& properties, const char* key, double least,
                                 const char* accepted) {
  const auto metadata = properties.find("metadata");
  if (!metadata || metadata->kind() != Value::Kind::map) return std::nullopt;
  const auto limit = metadata->find(key);
  if (!limit) return std::nullopt;
  const double value = limit->number();
  if (!(value >= least && value <= 100)) limit->fail(accepted, "leave the key out where there is no limit");
  return value;
}

class GraphReader {
 public:
  explicit GraphReader(const std::string& file) { graph_.file = file; }

  void add_node(const Node& properties, const Node& geometry) {
    if (const auto frame = properties.find("frame"); frame && frame->text() == "wgs84")
      frame->fail("a frame in metres, as map", "degrees are no metres: project them");
    const auto [x_m, y_m] = read_point(geometry["coordinates"]);
    const long id = properties["id"].integer();
    if (!index_of_.emplace(id, graph_.nodes.size()).second)
      properties["id"].fail("an id that no other node has");
    graph_.nodes.push_back({id, x_m, y_m});
  }

  /// Edges may share an id, as two of Nav2's own depot graph do. Without coordinates an edge is straight: the
  /// route server reads none.
  void add_edge(const Node& properties, const std::optional<Node>& geometry) {
    RouteGraph::Edge edge{
        .id = properties["id"].integer(),
        .start = index(properties["startid"]),
        .end = index(properties["endid"]),
        .speed_limit_m_s = read_limit(properties, "abs_speed_limit", 1e-3, "from 0.001 to 100 m/s"),
        .speed_limit_percent = read_limit(properties, "speed_limit", 0.1, "from 0.1 to 100 percent")};
    std::vector<std::vector<Node>> lines;
    const std::optional<Node> coordinates = geometry ? geometry->find("coordinates") : std::nullopt;
    if (coordinates && holds_lines(*coordinates))
      for (const auto& line : coordinates->items()) lines.push_back(line.items());
    else if (coordinates)
      lines.push_back(coordinates->items());
    for (const auto& line : lines)
      for (std::size_t i = 0; i < line.size(); ++i) {
        const auto [x_m, y_m] = read_point(line[i]);
        if (!at_node(edge.start, x_m, y_m) && !at_node(edge.end, x_m, y_m))
          edge.via_m.insert(edge.via_m.end(), {x_m, y_m});
      }
    graph_.edges.push_back(std::move(edge));
  }

  RouteGraph take() { return std::move(graph_); }

 private:
  /// By the depth of the lists: types are at times wrong, and the route server reads neither.
  static bool holds_lines(const Node& coordinates) {
    if (coordinates.kind() != Value::Kind::list || coordinates.items().empty()) return false;
    const Node first = coordinates.items().front();
    return first.kind() == Value::Kind::list && !first.items().empty() &&
           first.items().front().kind() == Value::Kind::list;
  }
  [[nodiscard]] bool at_node(std::size_t node, double x_m, double y_m) const {
    return std::hypot(graph_.nodes[node].x_m - x_m, graph_.nodes[node].y_m - y_m) < 1e-3;
  }
  [[nodiscard]] std::size_t index(const Node& id) const {
    const auto found = index_of_.find(id.integer());
    if (found == index_of_.end()) id.fail("the id of a node of this graph");
    return found->second;
  }

  RouteGraph graph_{};
  std::map<long, std::size_t> index_of_{};
};

bool is_in_degrees(const std::string& reference_system) {
  return reference_system.find("CRS84") != std::string::npos || reference_system.ends_with(":4326");
}

/// By the type of its geometry; without one, by the nodes that it names.
bool is_edge(const Node& feature) {
  const std::optional<Node> geometry = feature.find("geometry"),
                            type = geometry ? geometry->find("type") : std::nullopt;
  if (!type) return feature["properties"].has("startid");
  const bool line = type->text() == "LineString" || type->text() == "MultiLineString";
  if (!line && type->text() != "Point") type->fail("Point, LineString or MultiLineString");
  return line;
}

}  // namespace

RouteGraph read_route_graph(const std::string& file, const NamedBy& named_by,
                            std::vector<std::string>* notes) {
  const Document document = Document::parse(geojson_text(file, named_by, notes), file);
  const Node root = document.root();
  if (const std::string kind = inferred_kind(root); !kind.empty() && kind != "route graph")
    root.fail_found("a file of kind " + kind, "a route graph (GeoJSON FeatureCollection)");
  if (root.kind() != Value::Kind::map || root.text_or("type", "") != "FeatureCollection")
    root.fail("a route graph (GeoJSON FeatureCollection)");
  if (const auto crs = root.find("crs"); crs && crs->kind() == Value::Kind::map)
    if (const auto named = crs->find("properties"); named && named->kind() == Value::Kind::map)
      if (const auto name = named->find("name"); name && is_in_degrees(name->text()))
        name->fail("coordinates in metres, in the map's frame", "degrees are no metres: project them");
  GraphReader reader(file);
  const auto features = root["features"].items();
  for (const bool lines : {false, true})
    for (const auto& feature : features) {
      if (is_edge(feature) != lines) continue;
      lines ? reader.add_edge(feature["properties"], feature.find("geometry"))
            : reader.add_node(feature["properties"], feature["geometry"]);
    }
  RouteGraph graph = reader.take();
  if (graph.nodes.empty()) root["features"].fail_found("no points", "at least one node (Point)");
  return graph;
}

}  // namespace joulepath
