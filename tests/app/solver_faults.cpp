// Preloaded into the program: solvers and allocations that fail on command. IPOPT_FAULT, NLOPT_FAULT and
// OMPL_FAULT are the returned status. ALLOCATION_FAULT is the number of the allocation that fails, once;
// ALLOCATION_COUNT asks for the number of allocations, written to the standard error at the end.
#include <dlfcn.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> allocations{0};

/// The number that an environment variable holds, 0 without one.
long number_in(const char* variable) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::atol(text) : 0;
}

__attribute__((destructor)) void write_count() {
  if (std::getenv("ALLOCATION_COUNT") != nullptr)
    std::fprintf(stderr, "allocations: %ld\n", allocations.load());
}

}  // namespace

/// The program's operator new; every array and container of C++ comes through it.
void* operator new(std::size_t size) {
  static const long failing = number_in("ALLOCATION_FAULT");
  if (++allocations == failing) throw std::bad_alloc();
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

extern "C" {

/// Ipopt::IpoptApplication::OptimizeTNLP(const SmartPtr<TNLP>&)
int _ZN5Ipopt16IpoptApplication12OptimizeTNLPERKNS_8SmartPtrINS_4TNLPEEE(void* self, const void* problem) {
  if (const char* status = std::getenv("IPOPT_FAULT")) return std::atoi(status);
  using Original = int (*)(void*, const void*);
  static const auto original = reinterpret_cast<Original>(
      dlsym(RTLD_NEXT, "_ZN5Ipopt16IpoptApplication12OptimizeTNLPERKNS_8SmartPtrINS_4TNLPEEE"));
  return original(self, problem);
}

/// ompl::geometric::BITstar::solve(const PlannerTerminationCondition&), as called by its virtual table; the
/// problem stays without a solution.
int _ZN4ompl9geometric7BITstar5solveERKNS_4base27PlannerTerminationConditionE(void* self, const void* stop) {
  if (const char* status = std::getenv("OMPL_FAULT")) {
    std::fputs("OMPL found nothing\n", stderr);
    return std::atoi(status);
  }
  using Original = int (*)(void*, const void*);
  static const auto original = reinterpret_cast<Original>(
      dlsym(RTLD_NEXT, "_ZN4ompl9geometric7BITstar5solveERKNS_4base27PlannerTerminationConditionE"));
  return original(self, stop);
}

int nlopt_optimize(void* problem, double* x, double* value) {
  if (const char* status = std::getenv("NLOPT_FAULT")) return std::atoi(status);
  using Original = int (*)(void*, double*, double*);
  static const auto original = reinterpret_cast<Original>(dlsym(RTLD_NEXT, "nlopt_optimize"));
  return original(problem, x, value);
}
}
