#pragma once

#include "scenarios/mission_files/foreign_graph.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// The text of a Nav2 route graph (GeoJSON): the file itself, or what a LIF layout, a building or a
/// navigation graph of Open-RMF, or a graph of another extension says. Names of nodes and edges stand in
/// their metadata. `notes` gets what was not read. Throws ConfigError.
[[nodiscard]] std::string geojson_text(const std::string& file, const NamedBy& named_by = {},
                                       std::vector<std::string>* notes = nullptr);

/// Whether a file is a route graph in any of these forms.
[[nodiscard]] bool is_foreign_graph(const Document& document);
[[nodiscard]] bool is_graph_of_extension(const std::string& file);

}  // namespace joulepath
