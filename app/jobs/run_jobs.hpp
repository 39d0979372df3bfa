#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/jobs/job_part.hpp"
#include "app/jobs/shard.hpp"

// Design: docs/decisions/0700-results-and-jobs.md
namespace joulepath {

/// The result of one job.
struct JobResult {
  std::size_t index{};
  std::string line{};    ///< one JSON object
  std::string status{};  ///< a plan's status, or `bad_input`, `environment_error`, `internal_error`,
                         ///< `quarantined`
  double seconds{};
};

/// Jobs that each produce one result line: the missions of a batch, or the designs of a sweep.
class JobList {
 public:
  JobList() = default;
  JobList(const JobList&) = delete;
  JobList& operator=(const JobList&) = delete;
  virtual ~JobList() = default;

  [[nodiscard]] virtual std::size_t size() const = 0;

  /// The result of a job depends on this job only. Safe to call from several threads; every mistake in a
  /// job's input is reported in its line.
  [[nodiscard]] virtual JobResult plan(std::size_t index) = 0;

  /// The beginning of a job's line, which identifies the job.
  [[nodiscard]] virtual std::string name_line(std::size_t index) const = 0;

  /// Identifies a job and everything on which its result depends: the content of every file that it reads,
  /// the options and the program's build. Empty when a file cannot be read. Safe to call from several
  /// threads.
  [[nodiscard]] virtual std::string fingerprint(std::size_t index) = 0;

  /// Identifies the list: every job without the files that it names.
  [[nodiscard]] virtual std::string digest() const = 0;

  /// The options of the command line that change results, by their names.
  [[nodiscard]] virtual std::map<std::string, std::string> options() const = 0;

  /// Files and the digests of their content, for all jobs whose fingerprint was computed.
  [[nodiscard]] virtual std::map<std::string, std::string> files_read() const = 0;
};

/// Options for running a list of jobs.
struct JobRun {
  std::string command{};    ///< batch or sweep
  std::string source{};     ///< the files or folders of the jobs
  std::string directory{};  ///< holds the journal
  unsigned threads{1};
  bool resume{};
  bool force{};
  bool quiet{};
  std::string noun{"missions"};  ///< a job, for the progress
  const JobPart* part{};         ///< null: the whole list
  Shard shard{};
  std::map<std::size_t, std::string> quarantine{};  ///< jobs that are not run, with the reason
};

/// Runs the jobs of the shard that are not in the journal. Results by index; none if the user interrupted the
/// run (the journal then has the finished jobs). Throws ConfigError if an unfinished run would be
/// overwritten or if `resume` finds another run, EnvironmentError.
[[nodiscard]] std::optional<std::vector<JobResult>> run_job_list(JobList& jobs, const JobRun& run);

/// The journal of an unfinished run.
[[nodiscard]] std::string journal_file(const std::string& directory);

/// Deletes the journal of a run whose results were written.
void remove_journal(const std::string& directory);

/// Runs `work(k)` for the given indices on `threads` threads and passes each result to `done` (one call at a
/// time). Stops early if `stop` returns true. The first exception of `work` or `done` stops it too, and is
/// thrown when all threads are joined.
void run_jobs(const std::vector<std::size_t>& indices, unsigned threads,
              const std::function<JobResult(std::size_t)>& work,
              const std::function<void(const JobResult&)>& done, const std::function<bool()>& stop);

}  // namespace joulepath
