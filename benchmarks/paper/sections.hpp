#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/dataset.hpp"

namespace joulepath::bench {

/// One line of the summary: a table or figure of the paper and its status.
struct SummaryRow {
  std::string item{};
  std::string status{};  ///< reproduced | consistent | not reproduced | not possible
  std::string ours{};
  std::string printed{};
  std::string note{};
};

/// Input and output of the sections.
struct PaperReport {
  std::string plots_folder{};  ///< where SVG files go
  Robot robot{};
  Dataset straight{};
  Dataset bezier{};
  std::vector<SummaryRow> summary{};
  std::string text{};  ///< Markdown of the sections, in order
};

void coefficients_section(PaperReport& report);
void straight_section(PaperReport& report);
void bezier_section(PaperReport& report);
void turning_inertia_section(PaperReport& report);
void offset_section(PaperReport& report);
void planning_cost_section(PaperReport& report);

/// printf into a string.
[[gnu::format(printf, 1, 2)]] [[nodiscard]] std::string text(const char* pattern, ...);

/// The run of a dataset with this payload and acceleration; on a Bezier, of this bend (+1 left, -1 right,
/// 0 straight). Throws InternalError when there is none.
[[nodiscard]] const Run& find_run(const Dataset& dataset, double payload_kg, double acceleration_m_s2,
                                  double bend);

}  // namespace joulepath::bench
