#include "scenarios/robot_files/physical_bounds.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "scenarios/text/document.hpp"
#include "scenarios/text/schema_documents.hpp"
// Design: docs/decisions/0600-input-files.md

namespace joulepath {
namespace {

/// A row of scenarios/schemas/physical_bounds.yaml.
struct Bounds {
  std::string ending{};
  double least{}, most{};
  std::string why{};
};

const std::vector<Bounds>& all_bounds() {
  static const std::vector<Bounds> all = [] {
    const Document table = Document::parse(embedded::physical_bounds, "physical_bounds");
    std::vector<Bounds> rows;
    for (const auto& [ending, row] : table.root().entries()) {
      const std::vector<Node> items = row.items();
      rows.push_back({ending, items[0].number(), items[1].number(), items[2].text()});
    }
    return rows;
  }();
  return all;
}

const Bounds* bounds_of(std::string_view key) {
  const auto found =
      std::ranges::find_if(all_bounds(), [&](const Bounds& row) { return key.ends_with(row.ending); });
  return found == all_bounds().end() ? nullptr : &*found;
}

void bind(Schema& schema, std::string_view key) {
  if (key == "effects" || key == "uncertainty") return;
  if (schema.kind == Schema::Kind::number)
    if (const Bounds* bounds = bounds_of(key)) {
      Range& range = schema.range;
      range.max = std::min(range.max, bounds->most);
      range.min = std::max(range.min, -bounds->most);
      if (range.above_min && range.min == 0.0 && bounds->least > 0.0) {
        range.min = bounds->least;
        range.above_min = false;
      }
      range.least_size = bounds->least;
      range.why = bounds->why.c_str();
    }
  for (Schema& part : schema.parts) bind(part, key);
  for (Schema::Key& below : schema.keys) {
    const bool side =
        below.name == "left" || below.name == "right" || below.name == "from" || below.name == "to";
    bind(below.schema, side ? key : std::string_view(below.name));
  }
}

}  // namespace

Schema with_physical_bounds(Schema schema) {
  bind(schema, "");
  return schema;
}

double greatest_size(std::string_view key) {
  const Bounds* bounds = bounds_of(key);
  return bounds ? bounds->most : std::numeric_limits<double>::infinity();
}

}  // namespace joulepath
