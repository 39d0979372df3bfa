#pragma once

#include <string>

#include "app/cache_choice.hpp"
#include "app/command.hpp"
#include "app/jobs/run_jobs.hpp"

namespace joulepath {

class CommandLine;

/// Options of batch and sweep.
struct JobOptions {
  std::string out{};
  std::string shard{};
  std::string quarantine{};
  unsigned jobs{};
  bool resume{};
  CacheChoice cache{};
  CommonOptions common{};
};

void add_job_options(CommandLine& line, JobOptions& options, const std::string& files);
[[nodiscard]] JobRun job_run(const JobOptions& options, const std::string& noun);

}  // namespace joulepath
