#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/jobs/cache_choice.hpp"
#include "app/jobs/run_jobs.hpp"

namespace joulepath {

class CommandLine;

/// Options of batch and sweep.
struct JobOptions {
  std::string out{};
  unsigned jobs{};
  bool resume{};
  CacheChoice cache{};
  CommonOptions common{};
  std::vector<std::unique_ptr<JobPart>> parts{};  ///< of the extensions
};

void add_job_options(CommandLine& line, JobOptions& options, const std::string& files);
/// `sources`: the files or folders of the jobs. `noun`: a job, for the progress.
[[nodiscard]] JobRun job_run(const JobOptions& options, const std::string& command,
                             const std::vector<std::string>& sources, const std::string& noun);

}  // namespace joulepath
