#pragma once

#include <string>
#include <vector>

#include "app/command.hpp"
#include "app/output_directory.hpp"
#include "extensions/studies/study_file.hpp"

namespace joulepath {

/// The files of a whole sweep.
inline const std::vector<std::string> kSweepFiles{"sweep.csv", "sweep.json", "timings.jsonl", "report.html"};

[[nodiscard]] std::string title_of(const Study& study);

/// Writes the results of a whole sweep and prints its summary: a run and the merge of its shards on the
/// same day give the same bytes.
void finish_sweep(OutputDirectory& out, const Study& study, const std::vector<std::string>& lines,
                  const std::vector<std::string>& optimized, const CommonOptions& common);

}  // namespace joulepath
