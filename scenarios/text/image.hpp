#pragma once

#include <string>
#include <vector>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// A gray image, top row first: shade 0 (black) to 1 (white), and transparent pixels.
struct Image {
  int width{};
  int height{};
  std::vector<double> shade{};
  std::vector<bool> transparent{};  ///< empty: none
};

/// Reads PGM (P2, P5; 8 or 16 bits) or PNG (colors are averaged). Throws ConfigError for a missing,
/// truncated, oversized or unknown file; `named_by` is the place in the map file.
[[nodiscard]] Image read_image(const std::string& file, const NamedBy& named_by = {});

}  // namespace joulepath
