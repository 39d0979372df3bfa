#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

#include "model/stop.hpp"
#include "model/workers.hpp"

namespace joulepath {

/// Calls function(i) for i in [0, count) on the cores of the machine. Each call must write only data of its
/// own i; the result then does not depend on the order of execution. The first exception ends the loop and is
/// rethrown.
template <class Function>
void parallel_for(std::size_t count, Function&& function) {
  const std::size_t workers =
      std::min<std::size_t>({count, std::max(1u, std::thread::hardware_concurrency()), 8});
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      stop_if_asked();
      function(i);
    }
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        stop_if_asked();
        function(i);
      } catch (...) {
        next = count;
        const std::lock_guard<std::mutex> lock(error_mutex);
        if (!error) error = std::current_exception();
      }
    }
  };
  {
    const Workers beside(workers - 1, work);
    work();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace joulepath
