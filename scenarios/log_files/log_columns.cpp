#include "scenarios/log_files/log_columns.hpp"

#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {

Schema column_sources_schema() {
  const Schema source = schema_in(embedded::file_schemas, "column", false);
  std::vector<Schema::Key> keys;
  for (const auto& column : log_columns())
    if (column.measured) keys.push_back(optional(column.name, source));
  for (const char* name : kOrientationColumns) keys.push_back(optional(name, source));
  return map(std::move(keys));
}

ColumnSources read_column_sources(const Node& node) {
  ColumnSources sources;
  for (const auto& [name, entry] : node.entries()) {
    ColumnSource source{.scale = entry.number_or("scale", 1.0),
                        .offset = entry.number_or("offset", 0.0),
                        .is_unsigned = entry.boolean_or("unsigned", false),
                        .wraps_at = entry.optional_number("wraps_at"),
                        .derivative = entry.boolean_or("derivative", false),
                        .delay_s = entry.number_or("delay_s", 0.0),
                        .is_absent = entry.boolean_or("absent", false),
                        .mark = entry.mark()};
    if (const auto from = entry.find("from")) {
      if (from->kind() == Value::Kind::list)
        for (const auto& item : from->items()) source.from.push_back(item.text());
      else
        source.from.push_back(from->text());
    }
    if (source.scale == 0.0) entry["scale"].fail("a number other than 0");
    const bool of_wheel = name.rfind("motor_", 0) == 0;
    if (source.is_unsigned && !of_wheel)
      entry["unsigned"].fail("unsigned for motor_* columns only",
                             "the sign comes from the motion of the motor's wheel");
    if (name == "time_s")
      for (const char* key : {"derivative", "delay_s", "absent"})
        if (const auto extra = entry.find(key)) extra->fail("no such key", "time_s does not support it");
    sources[name] = std::move(source);
  }
  return sources;
}

ColumnSources sources_of_run(const Node& run, ColumnSources of_dataset) {
  if (const auto columns = run.find("columns"))
    for (auto& [name, source] : read_column_sources(*columns)) of_dataset[name] = std::move(source);
  return of_dataset;
}

}  // namespace joulepath
