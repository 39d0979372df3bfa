#include "scenarios/text/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "model/number_text.hpp"
#include "model/printable.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/utc_time.hpp"

namespace joulepath {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string shown(std::string_view cell) {
  std::string text;
  for (const char c : cell.substr(0, 40)) text += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return "\"" + text + (cell.size() > 40 ? "..." : "") + "\"";
}

bool holds_times(const std::string& name) {
  const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  return has("time") || has("Time") || has("stamp") || has("date") || has("Date");
}

class CsvParser {
 public:
  CsvParser(std::string_view text, std::string file, const std::function<bool(const std::string&)>& wanted)
      : rest_(text) {
    table_.file = std::move(file);
    if (text.find('\0') != std::string_view::npos) fail(0, "", "binary data", "a text file in CSV");
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
    read_header(wanted);
    const std::size_t guess = text.size() / std::max<std::size_t>(text.size() - rest_.size(), 16);
    for (std::size_t i = 0; i < wanted_.size(); ++i)
      if (wanted_[i]) table_.columns[i].reserve(guess);
    while (next_line()) read_row();
  }

  CsvTable take() { return std::move(table_); }

 private:
  [[noreturn]] void fail(std::size_t column, std::string key, std::string found, std::string accepted,
                         std::string hint = {}) const {
    throw ConfigError({{table_.file, line_number_, static_cast<int>(column) + 1},
                       std::move(key),
                       std::move(found),
                       std::move(accepted),
                       std::move(hint)});
  }

  /// Reads the next line that is not empty; false at the end.
  bool next_line() {
    while (!rest_.empty()) {
      const auto end = rest_.find('\n');
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_number_;
      if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
      if (!trimmed(line_).empty() && line_.front() != '#') return true;
    }
    return false;
  }

  /// One cell of the line from `position` on; moves `position` past its separator, or past the end after the
  /// last cell.
  std::string_view next_cell(std::size_t& position) const {
    if (line_[position] == '"') {
      const auto close = line_.find('"', position + 1);
      if (close == std::string_view::npos)
        fail(position, "", "a quote that is not closed", "a closing quote");
      const auto cell = line_.substr(position + 1, close - position - 1);
      const auto separator = line_.find(separator_, close);
      position = separator == std::string_view::npos ? line_.size() + 1 : separator + 1;
      return cell;
    }
    const auto separator = std::min(line_.find(separator_, position), line_.size());
    const auto cell = line_.substr(position, separator - position);
    position = separator + 1;
    return cell;
  }

  void read_header(const std::function<bool(const std::string&)>& wanted) {
    if (!next_line()) fail(0, "", "an empty file", "a header row, then one row per sample");
    for (const char candidate : {',', ';', '\t'})
      if (line_.find(candidate) != std::string_view::npos) {
        separator_ = candidate;
        break;
      }
    for (std::size_t position = 0; position <= line_.size();) {
      const std::size_t start = position;
      const auto cell = position < line_.size() ? next_cell(position) : (++position, std::string_view{});
      const std::string name = printable(trimmed(cell));
      if (parse_number(name))
        fail(start, "", "a number in the header", "a first row with the columns' names");
      const bool want = !name.empty() && wanted(name);
      if (want && std::find(table_.header.begin(), table_.header.end(), name) != table_.header.end())
        fail(start, name, "a duplicate column", "each column once");
      table_.header.push_back(name);
      wanted_.push_back(want);
    }
    table_.columns.resize(table_.header.size());
  }

  void read_row() {
    std::size_t index = 0;
    std::size_t position = 0;
    while (position <= line_.size()) {
      const std::size_t start = position;
      const auto cell = position < line_.size() ? next_cell(position) : (++position, std::string_view{});
      if (index < wanted_.size() && wanted_[index])
        table_.columns[index].push_back(value(cell, start, index));
      ++index;
    }
    if (index != wanted_.size())
      fail(0, "", "a row of " + std::to_string(index) + " cells",
           std::to_string(wanted_.size()) + ", as the header has",
           rest_.empty() ? "was the file cut off while it was written?" : "");
    table_.line_of_row.push_back(line_number_);
  }

  double value(std::string_view cell, std::size_t column, std::size_t index) const {
    if (cell.empty() || cell.front() == ' ' || cell.back() == ' ' || cell.front() == '\t' ||
        cell.back() == '\t')
      cell = trimmed(cell);
    if (cell.empty()) return kMissing;
    double number{};
    const char* first = cell.data() + (cell.front() == '+' ? 1 : 0);
    const auto [end, error] = std::from_chars(first, cell.data() + cell.size(), number);
    if (error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(number)) return number;
    if (const auto time_ns = holds_times(table_.header[index]) ? utc_nanoseconds(cell) : std::nullopt)
      return 1e-9 * static_cast<double>(*time_ns);
    const bool not_finite = error == std::errc{} && end == cell.data() + cell.size();
    fail(column, table_.header[index], shown(cell), "a finite number",
         not_finite                                 ? "leave the cell empty where a value is missing"
         : cell.find(',') != std::string_view::npos ? "the decimal sign is a point"
                                                    : "");
  }

  CsvTable table_{};
  std::vector<bool> wanted_{};
  std::string_view rest_;
  std::string_view line_{};
  int line_number_{};
  char separator_{','};
};

}  // namespace

std::size_t CsvTable::rows() const {
  std::size_t count = line_of_row.size();
  for (const std::vector<double>& column : columns) count = std::max(count, column.size());
  return count;
}

const std::vector<double>* CsvTable::find(std::string_view name) const {
  for (std::size_t i = 0; i < header.size(); ++i)
    if (header[i] == name) return &columns[i];
  return nullptr;
}

CsvTable parse_csv(std::string_view text, std::string file,
                   const std::function<bool(const std::string&)>& wanted) {
  return CsvParser(text, std::move(file), wanted).take();
}

CsvTable read_csv(const std::string& file, const std::function<bool(const std::string&)>& wanted,
                  const NamedBy& named_by) {
  return parse_csv(read_text_file(file, named_by), file, wanted);
}

std::string csv_text(const CsvColumns& columns) {
  std::string text;
  for (const auto& [name, values] : columns) text += (text.empty() ? "" : ",") + name;
  text += '\n';
  const std::size_t rows = columns.empty() ? 0 : columns.front().second->size();
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < columns.size(); ++i) {
      append_number(text, (*columns[i].second)[row]);
      text += i + 1 < columns.size() ? ',' : '\n';
    }
  return text;
}

}  // namespace joulepath
