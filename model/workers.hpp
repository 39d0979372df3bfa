#pragma once

#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace joulepath {

/// Threads that all run one function, joined at the end of the block. If the system gives fewer threads,
/// fewer run; the caller runs the function too, so that the work is always done.
class Workers {
 public:
  template <class Function>
  Workers(std::size_t count, const Function& function) {
    threads_.reserve(count);
    try {
      while (threads_.size() < count) threads_.emplace_back(function);
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

}  // namespace joulepath
