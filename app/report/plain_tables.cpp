#include "app/report/plain_tables.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/report/page_text.hpp"
#include "model/text_of_list.hpp"

namespace joulepath::report {
namespace {

using nlohmann::json;
constexpr std::size_t kMostTableRows = 200, kMostListed = 8;
constexpr int kDeepest = 6;  ///< of HTML's headings

std::string spaced(std::string key) {
  std::ranges::replace(key, '_', ' ');
  return escaped(key);
}

/// What one cell can hold: a number, a text, a short list of them.
bool is_plain(const json& value) {
  if (value.is_array())
    return value.size() <= kMostListed &&
           std::ranges::none_of(value, [](const json& item) { return item.is_structured(); });
  return !value.is_object();
}

/// Named values of one row, such as the parameters of a cause with their intervals.
bool is_list_of_values(const json& value) {
  return value.is_object() && !value.empty() && std::ranges::all_of(value, [](const json& entry) {
           return entry.is_object() && std::ranges::all_of(entry, is_plain);
         });
}

bool fits_a_cell(const json& value) { return is_plain(value) || is_list_of_values(value); }

std::string cell_text(const json& value) {
  if (value.is_object()) {
    std::string text;
    for (const auto& [name, entry] : value.items()) {
      text += (text.empty() ? "" : "; ") + spaced(name);
      for (const auto& [key, part] : entry.items()) text += ", " + spaced(key) + " " + cell_text(part);
    }
    return text;
  }
  if (value.is_null()) return "–";
  if (value.is_string()) return escaped(value.get<std::string>());
  if (value.is_number_float()) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value.get<double>());
    return text;
  }
  if (!value.is_array()) return value.dump();
  return text_of_list(value, cell_text);
}

bool is_table(const json& value) {
  return value.is_array() && !value.empty() &&
         std::ranges::all_of(value, [](const json& row) { return row.is_object(); });
}

std::string table_of(const json& rows) {
  std::vector<std::string> columns;
  for (const json& row : rows)
    for (const auto& [key, value] : row.items())
      if (fits_a_cell(value) && std::ranges::count(columns, key) == 0) columns.push_back(key);
  std::string text = "<table><thead><tr>";
  for (const std::string& column : columns) text += "<th scope=\"col\">" + spaced(column) + "</th>";
  text += "</tr></thead><tbody>\n";
  for (std::size_t k = 0; k < std::min(rows.size(), kMostTableRows); ++k) {
    text += "<tr>";
    for (const std::string& column : columns) {
      const bool has = rows[k].contains(column) && fits_a_cell(rows[k][column]);
      text += "<td>" + (has ? cell_text(rows[k][column]) : "") + "</td>";
    }
    text += "</tr>\n";
  }
  text += "</tbody></table>\n";
  if (rows.size() > kMostTableRows)
    text +=
        "<p>The first " + std::to_string(kMostTableRows) + " of " + std::to_string(rows.size()) + ".</p>\n";
  return text;
}

std::string object_text(const json& object, int depth) {
  std::string facts, parts;
  for (const auto& [key, value] : object.items()) {
    if (is_plain(value)) {
      facts += "<tr><th scope=\"row\">" + spaced(key) + "</th><td>" + cell_text(value) + "</td></tr>\n";
      continue;
    }
    const std::string inner = value.is_object() ? object_text(value, std::min(depth + 1, kDeepest))
                              : is_table(value) ? table_of(value)
                                                : "";
    const std::string heading = "h" + std::to_string(depth);
    if (!inner.empty()) parts += "<" + heading + ">" + spaced(key) + "</" + heading + ">\n" + inner;
  }
  return (facts.empty() ? "" : "<table><tbody>\n" + facts + "</tbody></table>\n") + parts;
}

}  // namespace

std::string plain_tables(const json& value) { return value.is_object() ? object_text(value, 2) : ""; }

}  // namespace joulepath::report
