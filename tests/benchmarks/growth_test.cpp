// Growth of the work with the size of the input, by what is counted: iterations, allocations, bytes.
// Design: docs/decisions/0800-build.md
#include <gtest/gtest.h>

#include "benchmarks/growth/growths.hpp"
#include "benchmarks/support/counted_memory.hpp"
#include "tests/scenarios/scratch_directory.hpp"

namespace joulepath::growth {
namespace {

constexpr double kSlack = 0.15;  ///< of an exponent: grids and iterations are whole numbers

TEST(Exponent, IsThePowerOfASeries) {
  std::vector<Work> works;
  for (const double size : {1.0, 2.0, 4.0, 8.0})
    works.push_back({.size = size, .cpu_ms = 3 * size * size, .iterations = 7, .allocations = 5 * size});
  EXPECT_NEAR(exponent(works, &Work::cpu_ms), 2.0, 1e-12);
  EXPECT_NEAR(exponent(works, &Work::iterations), 0.0, 1e-12);
  EXPECT_NEAR(exponent(works, &Work::allocations), 1.0, 1e-12);
  EXPECT_EQ(exponent(works, &Work::peak_MiB), 0.0);
}

TEST(MemoryCount, CountsWhatIsAllocatedAndTheMostAtATime) {
  if (!counts_memory()) GTEST_SKIP() << "the sanitizer has its own allocator";
  reset_memory_count();
  for (int k = 0; k < 10; ++k) {
    std::vector<char> block(1 << 20);
    block[static_cast<std::size_t>(k)] = 1;
    EXPECT_EQ(block[static_cast<std::size_t>(k)], 1);
  }
  const MemoryCount count = memory_count();
  EXPECT_GE(count.allocations, 10);
  EXPECT_NEAR(count.allocated_bytes, 10.0 * (1 << 20), 1e5);
  EXPECT_NEAR(count.peak_bytes, 1 << 20, 1e5);
}

TEST(Growth, OfCountedWorkIsNoMoreThanStated) {
  const ScratchDirectory scratch;
  for (const Growth& growth : growths(scratch.at("growth"))) {
    if (growth.small_sizes.empty()) continue;
    std::vector<Work> works;
    for (const double size : growth.small_sizes) works.push_back(measured(growth, size));
    EXPECT_LE(exponent(works, &Work::iterations), growth.most_exponent + kSlack) << growth.name;
    if (!counts_memory()) continue;
    for (double Work::*counted : {&Work::allocations, &Work::allocated_MiB, &Work::peak_MiB})
      EXPECT_LE(exponent(works, counted), growth.most_exponent + kSlack) << growth.name;
    EXPECT_GT(exponent(works, &Work::allocated_MiB), 0.0) << growth.name << ": the size has an influence";
  }
}

}  // namespace
}  // namespace joulepath::growth
