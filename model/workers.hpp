#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "model/progress.hpp"

namespace joulepath {

/// Threads that all run one function and count its steps as the caller's, joined at the end of the block. If
/// the system gives fewer threads, fewer run; the caller runs the function too, so that the work is always
/// done.
class Workers {
 public:
  template <class Function>
  Workers(std::size_t count, const Function& function) {
    threads_.reserve(count);
    try {
      while (threads_.size() < count)
        threads_.emplace_back([function, count = step_count] {
          const StepScope steps(count);
          function();
        });
    } catch (const std::exception&) {  // no memory, or a limit on threads
    }
  }
  ~Workers() {
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

 private:
  std::vector<std::thread> threads_{};
};

/// Calls work(index) for all indices below a count, on this thread and `threads - 1` more. After an exception
/// no further index is begun; the first one is thrown when all threads are joined.
template <class Function>
void for_each_index(std::size_t count, unsigned threads, const Function& work) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  std::exception_ptr error;
  std::mutex mutex;
  const auto loop = [&] {
    try {
      for (std::size_t k = next++; k < count && !failed; k = next++) work(k);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failed.exchange(true)) error = std::current_exception();
    }
  };
  {
    const std::size_t useful = threads < count ? threads : count;
    const Workers beside(useful > 1 ? useful - 1 : 0, loop);
    loop();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace joulepath
