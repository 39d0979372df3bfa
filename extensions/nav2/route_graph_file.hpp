#pragma once

#include <string>

#include "planner/path/search/route_graph.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// Reads a Nav2 route graph (GeoJSON: points with `id`, lines with `id`, `startid`, `endid`), or one of
/// another program (foreign_graphs.hpp). `notes` gets what was not read.
[[nodiscard]] RouteGraph read_route_graph(const std::string& file, const NamedBy& named_by = {},
                                          std::vector<std::string>* notes = nullptr);

}  // namespace joulepath
