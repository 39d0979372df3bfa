#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/output_directory.hpp"

namespace joulepath {

class CommandLine;
class JobList;
struct JobResult;
struct JobRun;

/// What the results of a part say about the whole list of jobs.
struct JobTitle {
  std::string title{};  ///< of the report
  std::string study_file{}, study_text{};
};

/// A choice among the jobs of a list, which an extension offers by options of its own.
class JobPart {
 public:
  JobPart() = default;
  JobPart(const JobPart&) = delete;
  JobPart& operator=(const JobPart&) = delete;
  virtual ~JobPart() = default;

  [[nodiscard]] virtual std::string example() const = 0;  ///< for the help of `batch`
  virtual void declare(CommandLine& line) = 0;
  /// Sets the run's shard, quarantine and part. Throws UsageError and ConfigError.
  virtual void choose(JobRun& run) const = 0;

  /// The files of a part's directory.
  [[nodiscard]] virtual const std::vector<std::string>& files() const = 0;
  /// Throws ConfigError if the directory holds the finished part of another run, which --resume would
  /// replace.
  virtual void check_finished(const JobList& jobs, const JobRun& run) const = 0;
  /// Writes the results of a part.
  virtual void write(OutputDirectory& out, const JobList& jobs, const std::vector<JobResult>& results,
                     const JobRun& run, const JobTitle& about) const = 0;
};

}  // namespace joulepath
