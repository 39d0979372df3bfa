#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "planner/cache/content_key.hpp"

namespace joulepath {

/// Answers as files of one folder that processes share: one file per key with a checksum of its content,
/// written under a temporary name and renamed. A file that is missing, damaged or of another key counts as no
/// answer, and the next answer replaces it. Answers that cannot be written (no space, no permission) are
/// dropped. When these files exceed the limit, the least recently used ones are deleted; other files of the
/// folder stay.
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
  std::uint64_t written_bytes_{};  ///< since the size of the folder was computed
  bool scanned_{};
};

}  // namespace joulepath
