#pragma once

#include <string>
#include <vector>

#include "diagnosis/values/data_check.hpp"
#include "diagnosis/values/isolability.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {

/// Summary of a file's content.
struct FileSummary {
  std::string kind{};
  std::string text{};
  std::vector<std::string> notes{};
  std::vector<DataCheck> data_checks{};  ///< of a dataset: channels that contradict physics
  Isolability isolability{};             ///< of a dataset whose channels are sound
  std::string proposal{};                ///< a proposed file: the dataset of a bag
  double begins_s{};                     ///< of a bag: the stamp of its first message; 0: unknown
  std::vector<ConfigError> errors{};     ///< of the lines of a list of missions that cannot be read
  std::string question{};                ///< of a dataset whose runs look like another robot's
  bool proposes{};  ///< files of this kind may have a proposal, which goes to standard output alone
};

/// The kinds that have a summary, in words.
[[nodiscard]] std::string checked_kinds();

/// Reads a file of any kind, with the files that it names, to check it. `kind`, the `schema:` line, the
/// file's extension or its keys determine the kind. `brief`: without the isolability of a dataset, which fits
/// the catalog to all runs. Throws ConfigError.
[[nodiscard]] FileSummary read_any_file(const std::string& file, const std::string& kind = {},
                                        const ReadOptions& options = {}, bool brief = false);

}  // namespace joulepath
