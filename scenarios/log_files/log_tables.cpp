#include "scenarios/log_files/log_tables.hpp"

#include <algorithm>
#include <filesystem>

namespace joulepath {

const LogReader* log_reader_of(const std::string& file, const NamedBy& named_by) {
  const auto found =
      std::ranges::find_if(registry().logs, [&](const LogReader& reader) { return reader.reads(file); });
  if (found != registry().logs.end()) return &*found;
  refuse_absent_file(file, named_by);
  return nullptr;
}

namespace {

bool is_csv(const std::string& file) { return std::filesystem::path(file).extension() == ".csv"; }

}  // namespace

std::string log_formats() {
  std::string names = "CSV";
  for (const LogReader& reader : registry().logs) names += ", " + reader.says;
  return names;
}

bool is_log_file(const std::string& file) { return is_csv(file) || log_reader_of(file); }

bool is_run_log(const std::string& file) {
  if (log_reader_of(file)) return true;
  if (!is_csv(file)) return false;
  const std::vector<std::string> header = read_csv(file, [](const std::string&) { return false; }).header;
  return std::ranges::count(header, "time_s") > 0;
}

}  // namespace joulepath
