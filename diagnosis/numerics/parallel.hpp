#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>

#include "model/stop.hpp"
#include "model/workers.hpp"

namespace joulepath {

/// Calls function(i) for i in [0, count) on the cores of the machine. Each call must write only data of its
/// own i; the result then does not depend on the order of execution. The first exception ends the loop and is
/// rethrown.
template <class Function>
void parallel_for(std::size_t count, const Function& function) {
  for_each_index(count, std::clamp(std::thread::hardware_concurrency(), 1u, 8u), [&](std::size_t i) {
    stop_if_asked();
    function(i);
  });
}

}  // namespace joulepath
