#pragma once

namespace joulepath {

/// Allocations of the whole process (malloc and its relatives, solvers included), counted in place of time:
/// the same on every machine. Linked into one program, the counters replace the C library's allocator
/// functions by ones that count and pass on.
struct MemoryCount {
  double allocations{};
  double allocated_bytes{};  ///< sum of all requests
  double peak_bytes{};       ///< largest sum in use at a time, beyond what was in use at the reset
};

/// False under a sanitizer that replaces the allocator itself: nothing is counted then.
[[nodiscard]] bool counts_memory();
void reset_memory_count();
[[nodiscard]] MemoryCount memory_count();

}  // namespace joulepath
