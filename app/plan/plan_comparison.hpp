#pragma once

#include <string>

#include "app/plan/plan_analysis.hpp"
#include "app/report/report.hpp"

namespace joulepath {

class CommandLine;

/// A comparison of a plan with something else than the classic profiles, which an option of `compare` asks
/// for.
class PlanComparison {
 public:
  PlanComparison() = default;
  PlanComparison(const PlanComparison&) = delete;
  PlanComparison& operator=(const PlanComparison&) = delete;
  virtual ~PlanComparison() = default;

  [[nodiscard]] virtual std::string example() const = 0;  ///< for the help of `compare`
  virtual void declare(CommandLine& line) = 0;
  [[nodiscard]] virtual bool is_asked() const = 0;
  /// Prints, and writes `result_file` and a page into `out` where the options ask for it. The exit code.
  [[nodiscard]] virtual int run(const Plan& plan, const report::MissionExtras& extras,
                                const AnalysisOptions& options, OutputDirectory& out,
                                const std::string& result_file) = 0;
};

}  // namespace joulepath
