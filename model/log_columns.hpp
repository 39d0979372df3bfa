#pragma once

#include <string>
#include <vector>

#include "model/trajectory.hpp"

namespace joulepath {

/// A column of the run log format and the channel of a Trajectory that it fills.
struct LogColumn {
  std::string name{};
  std::vector<double>& (*channel)(Trajectory&){};
  bool measured{};  ///< a run log may have it; the others only `plan` writes

  [[nodiscard]] const std::vector<double>& of(const Trajectory& trajectory) const {
    return channel(const_cast<Trajectory&>(trajectory));  // it only finds the channel
  }
};

/// All columns, in the order in which they are written.
[[nodiscard]] const std::vector<LogColumn>& log_columns();
[[nodiscard]] const LogColumn* find_log_column(const std::string& name);

}  // namespace joulepath
