#pragma once

#include <cstddef>
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

}  // namespace joulepath
