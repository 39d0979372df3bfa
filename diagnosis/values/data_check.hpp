#pragma once

#include <string>
#include <vector>

namespace joulepath {

/// How a column must be read so that a log agrees with physics: value = scale * value as read now.
struct ColumnRepair {
  std::string column{};
  double scale{1.0};
  std::string from{};  ///< the column whose readings belong here; empty: its own
  bool absent{};       ///< its readings say nothing: the column is left out
};

/// A log that contradicts physics, with the number that shows it.
struct DataCheck {
  std::vector<std::size_t> runs{};  ///< of the dataset
  std::string run{};                ///< their names, empty: all runs
  std::string channel{};
  std::string kind{};  ///< dead | inverted | swapped | unit | scaled | clock
  std::string evidence{};
  std::vector<ColumnRepair> columns{};  ///< empty: nothing repairs it, the runs must be left out
  std::string repair{};                 ///< the line of the dataset file that repairs it
};

}  // namespace joulepath
