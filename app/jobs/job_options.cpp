#include "app/jobs/job_options.hpp"

#include <algorithm>
#include <filesystem>
#include <thread>

#include "app/command_line.hpp"
#include "app/program_parts.hpp"
#include "model/text_of_list.hpp"

namespace joulepath {

void add_job_options(CommandLine& line, JobOptions& options, const std::string& files) {
  options.jobs = std::max(1u, std::thread::hardware_concurrency());
  line.option("--out", options.out, "directory for " + files).required();
  line.option("-j,--jobs", options.jobs, "number of plans made in parallel").between(1, 256).shows_default();
  options.parts = made(extension_parts().job_parts);
  for (const auto& part : options.parts) part->declare(line);
  line.flag("--resume", options.resume,
            "continue an interrupted run; finished plans with unchanged inputs are not repeated");
  add_cache_options(line, options.cache);
  add_common_flags(line, options.common, "qjfu");
}

JobRun job_run(const JobOptions& options, const std::string& command, const std::vector<std::string>& sources,
               const std::string& noun) {
  std::string names;
  for (const std::string& source : sources)
    append_item(names, std::filesystem::weakly_canonical(source).string(), " ");
  JobRun run{.command = command,
             .source = names,
             .directory = options.out,
             .threads = options.jobs,
             .resume = options.resume,
             .force = options.common.force,
             .quiet = options.common.quiet,
             .noun = noun};
  for (const auto& part : options.parts) part->choose(run);
  return run;
}

}  // namespace joulepath
