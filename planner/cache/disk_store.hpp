#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "planner/cache/content_key.hpp"

namespace joulepath {

/// Answers as files of one folder, shared by processes: one file per key, written beside its place and
/// renamed into it, with a checksum of its content. A file that is damaged, of another key or missing is no
/// answer; the next one that is kept replaces it. What cannot be written (no space, no permission) is not
/// kept. When the folder grows beyond its limit, the files that were used least recently are deleted.
///
/// Safe to share between threads.
class DiskStore {
 public:
  static constexpr std::uint64_t kLimit_bytes = 512ULL << 20;

  explicit DiskStore(std::string folder, std::uint64_t limit_bytes = kLimit_bytes)
      : folder_(std::move(folder)), limit_bytes_(limit_bytes) {}

  [[nodiscard]] std::optional<std::string> find(const ContentKey& key) const;
  void keep(const ContentKey& key, const std::string& answer);

 private:
  [[nodiscard]] std::string file_of(const ContentKey& key) const;
  void delete_oldest();

  std::string folder_;
  std::uint64_t limit_bytes_;
  std::mutex mutex_{};
  std::uint64_t written_bytes_{};  ///< since the folder's size was looked at
  bool looked_{};
};

}  // namespace joulepath
