#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "planner/cache/bytes.hpp"
#include "planner/cache/content_key.hpp"
#include "planner/cache/disk_store.hpp"

// Design: docs/decisions/0403-answers-by-content.md
namespace joulepath {

/// Answers identified by the content of their question. They are kept in memory up to a limit (the least
/// recently used are removed first), and in a folder if one is given. Safe to share between threads.
class AnswerCache {
 public:
  static constexpr std::uint64_t kLimit_bytes = 128ULL << 20;

  explicit AnswerCache(std::uint64_t limit_bytes = kLimit_bytes) : limit_bytes_(limit_bytes) {}
  /// Keeps answers in a folder as well, for other processes and later runs.
  explicit AnswerCache(const std::string& folder) : AnswerCache() { disk_.emplace(folder); }

  using Bytes = std::shared_ptr<const std::string>;
  [[nodiscard]] Bytes find(const ContentKey& key);
  void keep(const ContentKey& key, std::string answer);

 private:
  struct Entry {
    ContentKey key{};
    Bytes answer{};
  };
  void remember(const ContentKey& key, Bytes answer);

  std::uint64_t limit_bytes_;
  std::optional<DiskStore> disk_{};
  std::mutex mutex_{};
  std::uint64_t bytes_{};
  std::list<Entry> entries_{};  ///< the most recently used first
  std::map<ContentKey, std::list<Entry>::iterator> places_{};
};

/// The cache of a mission's answers, and the content common to all of its questions.
struct SharedAnswers {
  AnswerCache* cache{};  ///< null: no cache
  ContentKey world{};    ///< of the program, the robot and the floor
};

/// The answer to a question: from the cache, or from `compute()`. `kind`, the parts of the question and
/// `answers.world` must together contain everything on which the answer depends. A cached answer equals the
/// computed one to the last bit, so results do not depend on the content of the cache.
template <class Compute, class... Parts>
auto remembered(const SharedAnswers& answers, std::string_view kind, const Compute& compute,
                const Parts&... parts) -> decltype(compute()) {
  if (answers.cache == nullptr) return compute();
  ByteWriter question;
  question(kind, answers.world.first, answers.world.second, parts...);
  const ContentKey key = content_key(question.bytes());
  if (const AnswerCache::Bytes kept = answers.cache->find(key)) {
    decltype(compute()) answer{};
    ByteReader reader(*kept);
    reader(answer);
    if (reader.finished()) return answer;
  }
  decltype(compute()) answer = compute();
  ByteWriter writer;
  writer(answer);
  answers.cache->keep(key, writer.bytes());
  return answer;
}

}  // namespace joulepath
