#pragma once

#include <functional>
#include <utility>

namespace joulepath {

/// Called at the steps of a long computation on this thread; throws to end the computation early. Null: no
/// check.
inline thread_local const std::function<void()>* stop_check = nullptr;

/// A step of a long computation: lets the caller end it by an exception.
inline void stop_if_asked() {
  if (stop_check != nullptr) (*stop_check)();
}

/// Sets this thread's check for its lifetime.
class StopScope {
 public:
  explicit StopScope(std::function<void()> check)
      : check_(std::move(check)), before_(std::exchange(stop_check, &check_)) {}
  ~StopScope() { stop_check = before_; }
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;

 private:
  std::function<void()> check_;
  const std::function<void()>* before_;
};

}  // namespace joulepath
