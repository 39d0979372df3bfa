#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace joulepath {

/// The part of a list of jobs that one process runs: every `of`-th job, from `number` - 1 on, which
/// distributes neighboring hard jobs over the shards.
struct Shard {
  std::size_t number{1};  ///< 1 to `of`
  std::size_t of{1};
  bool is_asked_for{};  ///< by --shard: even 1/1 is a directory for merge

  [[nodiscard]] bool is_whole() const { return !is_asked_for; }
  [[nodiscard]] std::string text() const;  ///< 2/8; empty: the whole
  [[nodiscard]] std::vector<std::size_t> indices(std::size_t jobs) const;
};

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
