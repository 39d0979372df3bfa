#pragma once

#include <string>
#include <vector>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// One mission of many, not yet parsed, so that a broken one does not stop the others.
struct MissionItem {
  std::string name{};
  std::string file{};
  std::string text{};  ///< empty: in the file
  int first_line{1};
};

/// The missions of a directory (*.yaml, by name), of a file of JSON lines, or of one YAML file. Throws
/// ConfigError when there are none; `named_by` is the place of the source's name.
[[nodiscard]] std::vector<MissionItem> mission_items(const std::string& source, const NamedBy& named_by = {});

/// Those of several sources. A name that repeats has the path of its file before it.
[[nodiscard]] std::vector<MissionItem> mission_items(const std::vector<std::string>& sources);

/// The item's text, parsed. Throws ConfigError.
[[nodiscard]] Document document_of(const MissionItem& item);

}  // namespace joulepath
