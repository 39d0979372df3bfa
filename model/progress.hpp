#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace joulepath {

class StepCount;

/// The count of the computation on this thread and on its workers. Null: nobody counts.
inline thread_local StepCount* step_count = nullptr;

/// Sets this thread's count for its lifetime; null keeps steps within a step out of the count.
class StepScope {
 public:
  explicit StepScope(StepCount* count) : before_(std::exchange(step_count, count)) {}
  ~StepScope() { step_count = before_; }
  StepScope(const StepScope&) = delete;
  StepScope& operator=(const StepScope&) = delete;

 private:
  StepCount* before_;
};

/// Counts the steps of a long computation and reports after each, and when it expects more, how many are
/// done and how many are expected so far. A report may throw, which ends the computation.
class StepCount {
 public:
  using Report = std::function<void(std::size_t done, std::size_t expected)>;
  explicit StepCount(Report report) : report_(std::move(report)) {}

  void expect(std::size_t steps) {
    const std::lock_guard lock(mutex_);
    expected_ += steps;
    tell();
  }
  void advance(std::size_t steps) {
    const std::lock_guard lock(mutex_);
    done_ += steps;
    expected_ = std::max(expected_, done_);
    tell();
  }
  /// The computation is done: so are steps that it did not need.
  void finish() {
    const std::lock_guard lock(mutex_);
    if (std::exchange(done_, expected_) < expected_) tell();
  }

 private:
  void tell() const {
    const StepScope uncounted(nullptr);
    report_(done_, expected_);
  }

  Report report_;
  std::mutex mutex_{};
  std::size_t done_{}, expected_{};
};

inline void expect_steps(std::size_t steps) {
  if (step_count != nullptr && steps > 0) step_count->expect(steps);
}

inline void finish_steps(std::size_t steps = 1) {
  if (step_count != nullptr && steps > 0) step_count->advance(steps);
}

}  // namespace joulepath
