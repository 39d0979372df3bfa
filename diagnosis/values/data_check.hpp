#pragma once

#include <string>
#include <vector>

namespace joulepath {

/// Repair of a column so that the log agrees with physics: value = scale * present value.
struct ColumnRepair {
  std::string column{};
  double scale{1.0};
  std::string from{};  ///< column with the correct readings; empty: the same column
  bool absent{};       ///< the readings carry no information and are left out
};

/// A log error that contradicts physics, with the number that shows it.
struct DataCheck {
  std::vector<std::size_t> runs{};  ///< indices of the dataset's runs
  std::string run{};                ///< their names; empty: all runs
  std::string channel{};
  std::string kind{};  ///< dead | inverted | swapped | unit | scaled | clock
  std::string evidence{};
  std::vector<ColumnRepair> columns{};  ///< empty: no repair, the runs must be left out
  std::string repair{};                 ///< line of the dataset file that repairs the column
};

}  // namespace joulepath
