#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/prediction/rows.hpp"

namespace joulepath {

/// One entry of the dictionary: hats and harmonics of all measured quantities, without laws. The
/// dictionary tells how much of a gap any function of these quantities could explain, and on which quantity
/// it depends.
struct DictionaryEntry {
  std::string family{};   ///< "wheel speed", "place", "heading", ...
  std::string channel{};  ///< "current", "current reading", "voltage", "motion" or one of the battery's
  std::string curve{};    ///< EffectInfo::curve of an effect with these rows; beside it no unknown
};

/// Ranges of the variables over a whole dataset, for the grids of the hats.
struct DictionaryLayout {
  double greatest_wheel_speed_rad_s{1};
  double greatest_yaw_rate_rad_s{1};
  double greatest_payload_kg{1};
  double greatest_current_A{1};
  double x_min_m{}, x_max_m{1}, y_min_m{}, y_max_m{1};
  double day_begin_s{}, day_end_s{1};
  bool has_place{};
  bool has_day{};
};

[[nodiscard]] DictionaryLayout lay_out(const std::vector<RunSignals>& runs, const Robot& robot);

/// Families of the entries, in the order of dictionary_rows(); equal for all runs.
[[nodiscard]] std::vector<DictionaryEntry> dictionary_entries(const DictionaryLayout& layout);

/// One matrix (samples x kChannelCount) per entry.
[[nodiscard]] std::vector<Eigen::MatrixXd> dictionary_rows(const DictionaryLayout& layout,
                                                           const RunSignals& signals, const Robot& robot,
                                                           const Prediction& prediction);

}  // namespace joulepath
