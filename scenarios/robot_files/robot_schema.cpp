#include "model/limit_table.hpp"
#include "scenarios/robot_files/effect_list.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/robot_files/robot_file.hpp"
#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {
namespace {

Schema part(const std::string& name) { return schema_in(embedded::robot_schemas, name, false); }

/// Keys of `limits:`, or of a row of `by_payload`.
std::vector<Schema::Key> limit_schema_keys(bool by_payload) {
  std::vector<Schema::Key> keys;
  for (const Limit& limit : kLimits)
    if (limit.field != nullptr && limit.in_limits && (limit.by_payload || !by_payload))
      keys.push_back(optional(std::string(limit.key), number(limit.may_be_zero ? kNotNegative : kPositive),
                              std::string(limit.meaning) + (by_payload ? "; absent: as outside of by_payload"
                                                                       : "; absent: no limit")));
  return keys;
}

Schema limits_schema() {
  std::vector<Schema::Key> keys = limit_schema_keys(false), row = limit_schema_keys(true);
  row.insert(row.begin(), required("payload_kg", number(kNotNegative), "these limits hold at this payload"));
  keys.push_back(optional(
      "by_payload", list(map(row), 1),
      "limits that depend on payload: interpolated between rows, overrides; beyond the rows the nearest "
      "one holds; a row without a key has its value outside of by_payload"));
  return map(std::move(keys));
}

Schema uncertainty_schema() {
  constexpr Range relative{.min = 0.0, .max = 1.0, .why = "relative, 1 sigma: 0.015 is 1.5 %"};
  std::vector<Schema::Key> keys;
  for (const char* section : {"geometry", "inertia", "motor", "power", "battery"})
    for (const auto& key : part(section).keys)
      if (key.schema.kind == Schema::Kind::number || key.schema.kind == Schema::Kind::any_of)
        keys.push_back(optional(key.name, number(relative)));
  keys.push_back(optional("payload_kg", number(relative)));
  keys.push_back(optional("model_energy", number(relative),
                          "of the model itself: relative 1-sigma of a mission's energy of motion"));
  return map(std::move(keys));
}

}  // namespace

Schema robot_schema() {
  return with_physical_bounds(schema_in(embedded::robot_schemas, "robot", false,
                                        {{"limits", limits_schema()},
                                         {"effects", effect_list_schema()},
                                         {"uncertainty", uncertainty_schema()}}));
}

std::vector<std::string> required_robot_keys() {
  std::vector<std::string> keys;
  for (const Schema::Key& section : robot_schema().keys)
    for (const Schema::Key& key : section.schema.keys)
      if (section.required && key.required) keys.push_back(section.name + "." + key.name);
  return keys;
}

}  // namespace joulepath
