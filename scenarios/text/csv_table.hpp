#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// The requested columns of a CSV file, as numbers; an empty cell is NaN.
struct CsvTable {
  std::string file{};
  std::vector<std::string> header{};           ///< all names, in the file's order
  std::vector<std::vector<double>> columns{};  ///< one per name; empty if it was not requested
  std::vector<int> line_of_row{};              ///< empty for a table that is no file of lines

  [[nodiscard]] const std::vector<double>* find(std::string_view name) const;
  [[nodiscard]] std::size_t rows() const;
  /// The line of a row, 0 without lines.
  [[nodiscard]] int line(std::size_t row) const { return line_of_row.empty() ? 0 : line_of_row[row]; }
};

/// Reads a CSV file: a header row, then one row per sample; comma, semicolon or tab (as in the header),
/// quotes, CRLF and a byte order mark are accepted, lines that begin with # are comments. Dates with a time
/// of day (ISO 8601) in a column of times are seconds since 1970. Throws ConfigError with line and column: no
/// header, a name twice, a row of another length, text or a non-finite number in a requested column.
[[nodiscard]] CsvTable read_csv(const std::string& file,
                                const std::function<bool(const std::string&)>& wanted,
                                const NamedBy& named_by = {});
[[nodiscard]] CsvTable parse_csv(std::string_view text, std::string file,
                                 const std::function<bool(const std::string&)>& wanted);

/// Columns of numbers of one length, by name.
using CsvColumns = std::vector<std::pair<std::string, const std::vector<double>*>>;
/// A CSV file: a header, then shortest exact numbers.
[[nodiscard]] std::string csv_text(const CsvColumns& columns);

}  // namespace joulepath
