#include "app/jobs/run_jobs.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>

#include "app/interrupt.hpp"
#include "app/jobs/journal.hpp"
#include "app/progress.hpp"
#include "model/config_error.hpp"
#include "model/printable.hpp"
#include "model/workers.hpp"

namespace joulepath {
namespace {

/// The result of a job that is not run.
JobResult quarantined(const JobList& jobs, std::size_t index, const std::string& reason) {
  auto line = nlohmann::ordered_json::parse(jobs.name_line(index));
  line["status"] = "quarantined";
  line["message"] = printable(reason);
  return {.index = index, .line = line.dump(), .status = "quarantined"};
}

}  // namespace

std::optional<std::vector<JobResult>> run_job_list(JobList& jobs, const JobRun& run) {
  const std::string file = journal_file(run.directory);
  if (std::filesystem::exists(file) && !run.resume && !run.force)
    throw ConfigError({{file, 0, 0},
                       "",
                       "the results of an unfinished run",
                       "--resume, which continues it",
                       "--force deletes them and starts again"});
  std::filesystem::create_directories(run.directory);
  JobJournal journal(file, run.resume ? JobJournal::Use::resume : JobJournal::Use::anew);
  const std::vector<std::size_t> indices = run.shard.indices(jobs.size());
  std::vector<JobResult> results(indices.size());
  std::vector<std::string> fingerprints;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    fingerprints.push_back(jobs.fingerprint(indices[i]));
    if (const auto held = run.quarantine.find(indices[i]); held != run.quarantine.end())
      results[i] = quarantined(jobs, indices[i], held->second);
    else if (const JobResult* earlier = journal.find(indices[i], fingerprints[i]))
      results[i] = *earlier;
    else
      open.push_back(i);
  }
  const PoliteInterrupt interrupt;
  {
    Progress progress(run.noun, open.size(), run.quiet);
    run_jobs(
        open, run.threads,
        [&](std::size_t i) {
          JobResult result = jobs.plan(indices[i]);
          result.index = i;
          return result;
        },
        [&](const JobResult& done) {
          JobResult& result = results[done.index] = done;
          result.index = indices[done.index];
          journal.add(result, fingerprints[done.index]);
          progress.advance();
        },
        [] { return PoliteInterrupt::requested(); });
  }
  if (!PoliteInterrupt::requested()) return results;
  std::cerr << "interrupted; --resume continues\n";
  return std::nullopt;
}

std::string journal_file(const std::string& directory) { return directory + "/results.partial.jsonl"; }

void remove_journal(const std::string& directory) { std::filesystem::remove(journal_file(directory)); }

void run_jobs(const std::vector<std::size_t>& indices, unsigned threads,
              const std::function<JobResult(std::size_t)>& work,
              const std::function<void(const JobResult&)>& done, const std::function<bool()>& stop) {
  std::mutex mutex;
  for_each_index(indices.size(), threads, [&](std::size_t k) {
    if (stop()) return;
    const JobResult result = work(indices[k]);
    const std::lock_guard lock(mutex);
    done(result);
  });
}

}  // namespace joulepath
