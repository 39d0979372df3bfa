#pragma once

#include <string>
#include <vector>

#include "app/jobs/job_options.hpp"
#include "app/output_directory.hpp"

namespace joulepath {

/// The files of a whole batch.
inline const std::vector<std::string> kBatchFiles{"results.jsonl", "timings.jsonl", "report.html"};

/// The directory of a whole run, with `files`, or of a part of it.
[[nodiscard]] OutputDirectory job_output(const JobOptions& options, const JobRun& run,
                                         const std::vector<std::string>& files);

[[nodiscard]] std::vector<std::string> lines_of(const std::vector<JobResult>& results);
/// The lines with their ends.
[[nodiscard]] std::string joined(const std::vector<std::string>& lines);

/// timings.jsonl: data that may differ between runs are not part of the results.
void add_timings(OutputDirectory& out, const std::vector<JobResult>& results);

/// Writes the results of a whole run and prints its summary: a run and the merge of its parts give the same
/// bytes.
[[nodiscard]] int finish_batch(OutputDirectory& out, const std::string& title,
                               const std::vector<std::string>& lines, const CommonOptions& common);

}  // namespace joulepath
