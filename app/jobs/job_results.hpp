#pragma once

#include <string>
#include <vector>

#include "app/jobs/job_options.hpp"
#include "app/output_directory.hpp"
#include "scenarios/study_file.hpp"

namespace joulepath {

/// The files of a whole run; a shard writes kShardFiles.
inline const std::vector<std::string> kBatchFiles{"results.jsonl", "timings.jsonl", "report.html"};
inline const std::vector<std::string> kSweepFiles{"sweep.csv", "sweep.json", "timings.jsonl", "report.html"};
inline const std::vector<std::string> kShardFiles{"results.jsonl", "timings.jsonl", "shard.json"};
[[nodiscard]] OutputDirectory job_output(const JobOptions& options, const Shard& shard,
                                         const std::vector<std::string>& files);

[[nodiscard]] std::vector<std::string> lines_of(const std::vector<JobResult>& results);
[[nodiscard]] std::string title_of(const Study& study);

/// timings.jsonl: data that may differ between runs are not part of the results.
void add_timings(OutputDirectory& out, const std::vector<JobResult>& results);

/// Writes a shard's lines and the data for merge; `about` has the data that the list of jobs does not have.
void write_shard(OutputDirectory& out, const JobList& jobs, const std::vector<JobResult>& results,
                 ShardManifest about);

/// Write the results of a whole run and print its summary: a run and the merge of its shards give the same
/// bytes.
void finish_batch(OutputDirectory& out, const std::string& title, const std::vector<std::string>& lines,
                  const CommonOptions& common);
void finish_sweep(OutputDirectory& out, const Study& study, const std::vector<std::string>& lines,
                  const std::vector<std::string>& optimized, const CommonOptions& common);

}  // namespace joulepath
