#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/jobs/mission_planner.hpp"
#include "extensions/studies/study_file.hpp"

namespace joulepath {

/// The plans of a study: every design on every mission, design by design. A result line has the design's
/// number, the mission's name, the parameters, and the plan's figures.
class SweepJobs : public JobList {
 public:
  /// Throws ConfigError: check_designs() of the first mission.
  SweepJobs(const Study& study, const PlanOptions& options, const ReadOptions& reading,
            const CacheChoice& cache = {.none = true});

  [[nodiscard]] std::size_t size() const override { return study_.designs.size() * missions_.size(); }
  [[nodiscard]] JobResult plan(std::size_t index) override;
  [[nodiscard]] std::string name_line(std::size_t index) const override;
  [[nodiscard]] std::string fingerprint(std::size_t index) override;
  [[nodiscard]] std::string digest() const override;
  [[nodiscard]] std::map<std::string, std::string> options() const override { return planner_.options(); }
  [[nodiscard]] std::map<std::string, std::string> files_read() const override {
    return planner_.files_read();
  }

  /// The result lines of a design that is not in the table (of --optimize), one per mission.
  [[nodiscard]] std::vector<JobResult> plan_design(const std::vector<std::string>& design,
                                                   std::size_t number);

 private:
  [[nodiscard]] nlohmann::ordered_json line_of(const MissionItem& mission,
                                               const std::vector<std::string>& design, std::size_t number,
                                               std::size_t index) const;
  [[nodiscard]] JobResult plan_on(const MissionItem& mission, const std::vector<std::string>& design,
                                  std::size_t number, std::size_t index);

  const Study& study_;
  std::vector<MissionItem> missions_{};
  ReadOptions reading_;
  MissionPlanner planner_;
};

}  // namespace joulepath
