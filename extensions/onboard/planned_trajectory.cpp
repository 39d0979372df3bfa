#include "extensions/onboard/planned_trajectory.hpp"

#include <filesystem>

#include "model/log_columns.hpp"
#include "scenarios/text/csv_table.hpp"

namespace joulepath {

Trajectory read_planned_trajectory(const std::string& directory, const std::vector<std::string>& needed) {
  const std::string file = (std::filesystem::path(directory) / "trajectory.csv").string();
  if (!std::filesystem::exists(file))
    throw ConfigError({{directory, 0, 0},
                       "",
                       std::filesystem::is_directory(directory) ? "a directory without trajectory.csv"
                       : std::filesystem::exists(directory)     ? "a file"
                                                                : "nothing with this name",
                       "the directory of a plan, as `joulepath plan --out` writes it",
                       ""});
  const CsvTable table = read_csv(file, [](const std::string& name) { return find_log_column(name); });
  const char* const hint = "name the directory that `joulepath plan` wrote";
  for (const std::string& name : needed)
    if (!table.find(name)) throw ConfigError({{file, 1, 1}, name, "nothing", "a column of numbers", hint});
  if (table.rows() < 2)
    throw ConfigError({{file, 1, 1}, "", "fewer than 2 rows", "the samples of a plan", hint});
  Trajectory trajectory;
  for (const LogColumn& column : log_columns())
    if (const std::vector<double>* values = table.find(column.name)) column.channel(trajectory) = *values;
  return trajectory;
}

}  // namespace joulepath
