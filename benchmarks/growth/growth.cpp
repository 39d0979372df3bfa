// Time and memory against size -> a table with fitted exponents. usage: bench_growth FOLDER HEADER [PART OF A
// NAME]
#include <algorithm>
#include <cstdio>
#include <string>

#include "benchmarks/growth/growths.hpp"

namespace {

using namespace joulepath::growth;

/// Fixed costs hide the growth of small sizes: exponents are those of the largest ones.
constexpr std::size_t kFitted = 4;

void section(const Growth& growth) {
  std::vector<Work> works;
  for (const double size : growth.sizes) {
    works.push_back(measured(growth, size));
    std::fprintf(stderr, "%s: %g in %.0f ms\n", growth.name.c_str(), size, works.back().cpu_ms);
  }
  std::printf("\n## %s\n\n%s.\n\n", growth.name.c_str(), growth.remark.c_str());
  std::printf(
      "| size | CPU ms | iterations | allocations | allocated MiB | peak MiB "
      "|\n|---:|---:|---:|---:|---:|---:|\n");
  for (const Work& w : works)
    std::printf("| %.10g | %.1f | %.0f | %.0f | %.1f | %.2f |\n", w.size, w.cpu_ms, w.iterations,
                w.allocations, w.allocated_MiB, w.peak_MiB);
  const std::vector<Work> largest(works.end() - std::min<std::ptrdiff_t>(kFitted, std::ssize(works)),
                                  works.end());
  std::printf("| **exponent** | %.2f | %.2f | %.2f | %.2f | %.2f |\n", exponent(largest, &Work::cpu_ms),
              exponent(largest, &Work::iterations), exponent(largest, &Work::allocations),
              exponent(largest, &Work::allocated_MiB), exponent(largest, &Work::peak_MiB));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  std::printf("# Growth\n\n%s\n\n", argv[2]);
  std::printf(
      "CPU time and memory against the size of the input. Exponents are fitted to the %zu largest sizes: 1 "
      "is linear.\n"
      "Allocations are counted (calls of malloc), and do not depend on the machine; the peak is beyond the "
      "input.\n",
      kFitted);
  for (const Growth& growth : growths(argv[1]))
    if (argc < 4 || growth.name.find(argv[3]) != std::string::npos) section(growth);
}
