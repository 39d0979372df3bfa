#include "planner/cache/answer_cache.hpp"

namespace joulepath {

AnswerCache::Bytes AnswerCache::find(const ContentKey& key) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto place = places_.find(key); place != places_.end()) {
      entries_.splice(entries_.begin(), entries_, place->second);
      return place->second->answer;
    }
  }
  if (!disk_) return nullptr;
  std::optional<std::string> read = disk_->find(key);
  if (!read) return nullptr;
  const auto answer = std::make_shared<const std::string>(std::move(*read));
  remember(key, answer);
  return answer;
}

void AnswerCache::keep(const ContentKey& key, std::string answer) {
  if (disk_) disk_->keep(key, answer);
  remember(key, std::make_shared<const std::string>(std::move(answer)));
}

void AnswerCache::remember(const ContentKey& key, Bytes answer) {
  const std::lock_guard lock(mutex_);
  if (places_.contains(key)) return;
  bytes_ += answer->size();
  entries_.push_front({key, std::move(answer)});
  places_.emplace(key, entries_.begin());
  while (bytes_ > limit_bytes_ && !entries_.empty()) {
    bytes_ -= entries_.back().answer->size();
    places_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

}  // namespace joulepath
