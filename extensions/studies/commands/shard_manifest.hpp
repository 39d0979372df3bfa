#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "app/jobs/shard.hpp"

namespace joulepath {

/// The shard of a text `K/N`; empty: the whole. Throws UsageError.
[[nodiscard]] Shard shard_from(const std::string& text);

/// The data of a shard for joulepath merge: shard.json.
struct ShardManifest {
  std::string command{};  ///< batch or sweep
  std::string version{};  ///< of the program
  std::string build{};    ///< kBuildId of the program
  Shard shard{};
  std::size_t jobs{};                            ///< of all shards
  std::string title{};                           ///< of the report
  std::map<std::string, std::string> options{};  ///< that change results: --nodes, ...
  std::string list_digest{};                     ///< of the jobs without the files that they name
  std::map<std::string, std::string> files{};    ///< digest of each file that this shard's jobs read
  std::string results_digest{};                  ///< of the result lines
  std::string study_file{}, study_text{};        ///< of a sweep
};

[[nodiscard]] std::string manifest_text(const ShardManifest& manifest);

/// Reads DIRECTORY/shard.json. Throws ConfigError.
[[nodiscard]] ShardManifest read_manifest(const std::string& directory);

/// True where a directory has the manifest of a finished shard.
[[nodiscard]] bool has_manifest(const std::string& directory);

/// Throws ConfigError unless the shards are all parts of one run of this build: same command, options, jobs
/// and files, each number once, none missing. `directories` and `shards` go together.
void check_complete(const std::vector<std::string>& directories, const std::vector<ShardManifest>& shards);

}  // namespace joulepath
