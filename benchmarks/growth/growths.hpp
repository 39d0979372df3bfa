#pragma once

#include <functional>
#include <string>
#include <vector>

namespace joulepath::growth {

/// What a run of one size took.
struct Work {
  double size{};
  double cpu_ms{};
  double iterations{};  ///< of the solvers; 0 where there are none
  double allocations{};
  double allocated_MiB{};
  double peak_MiB{};
};

/// One quantity that grows. `prepare` makes the input of a size, which is not measured, and returns the run;
/// a run returns the iterations of its solvers.
struct Growth {
  std::string name{};
  std::vector<double> sizes{};        ///< of the benchmark
  std::vector<double> small_sizes{};  ///< of the test; empty: left out
  std::function<std::function<double()>(double size)> prepare{};
  double most_exponent{1.0};  ///< of CPU time, allocations and memory
  std::string remark{};       ///< why the exponent is what it is
};

/// All of them. `folder`: for the files that are written and read.
[[nodiscard]] std::vector<Growth> growths(const std::string& folder);

[[nodiscard]] Work measured(const Growth& growth, double size);

/// Least-squares slope of log(value) over log(size); values that are not positive are left out.
[[nodiscard]] double exponent(const std::vector<Work>& works, double Work::*value);

}  // namespace joulepath::growth
