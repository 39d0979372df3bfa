#include "benchmarks/support/counted_memory.hpp"

#include <malloc.h>

#include <atomic>
#include <cstddef>

namespace {

std::atomic<long long> allocations{0}, allocated_bytes{0}, bytes_in_use{0}, most_bytes{0}, bytes_at_reset{0};

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool kCounts = true;

void count(void* memory, std::size_t size) {
  if (memory == nullptr) return;
  ++allocations;
  allocated_bytes += static_cast<long long>(size);
  const auto used = static_cast<long long>(malloc_usable_size(memory));
  const long long now = bytes_in_use += used;
  long long most = most_bytes;
  while (now > most && !most_bytes.compare_exchange_weak(most, now)) {
  }
}

void forget(void* memory) {
  if (memory != nullptr) bytes_in_use -= static_cast<long long>(malloc_usable_size(memory));
}
#else
constexpr bool kCounts = false;
#endif

}  // namespace

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {  // glibc's names of its own functions
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);

void* malloc(std::size_t size) {
  void* memory = __libc_malloc(size);
  count(memory, size);
  return memory;
}
void* calloc(std::size_t number, std::size_t size) {
  void* memory = __libc_calloc(number, size);
  count(memory, number * size);
  return memory;
}
void* realloc(void* old, std::size_t size) {
  forget(old);
  void* memory = __libc_realloc(old, size);
  count(memory, size);
  return memory;
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  void* memory = __libc_memalign(alignment, size);
  count(memory, size);
  return memory;
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = __libc_memalign(alignment, size);
  count(*memory, size);
  return *memory == nullptr ? 12 : 0;  // ENOMEM
}
void free(void* memory) {
  forget(memory);
  __libc_free(memory);
}
}
#endif

namespace joulepath {

bool counts_memory() { return kCounts; }

void reset_memory_count() {
  allocations = allocated_bytes = 0;
  bytes_at_reset = most_bytes = bytes_in_use.load();
}

MemoryCount memory_count() {
  return {.allocations = static_cast<double>(allocations.load()),
          .allocated_bytes = static_cast<double>(allocated_bytes.load()),
          .peak_bytes = static_cast<double>(most_bytes.load() - bytes_at_reset.load())};
}

}  // namespace joulepath
