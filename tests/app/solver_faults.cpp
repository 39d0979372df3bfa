// Preloaded into the program: solvers that fail on command. IPOPT_FAULT and NLOPT_FAULT are the returned
// status.
#include <dlfcn.h>

#include <cstdlib>

extern "C" {

/// Ipopt::IpoptApplication::OptimizeTNLP(const SmartPtr<TNLP>&)
int _ZN5Ipopt16IpoptApplication12OptimizeTNLPERKNS_8SmartPtrINS_4TNLPEEE(void* self, const void* problem) {
  if (const char* status = std::getenv("IPOPT_FAULT")) return std::atoi(status);
  using Original = int (*)(void*, const void*);
  static const auto original = reinterpret_cast<Original>(
      dlsym(RTLD_NEXT, "_ZN5Ipopt16IpoptApplication12OptimizeTNLPERKNS_8SmartPtrINS_4TNLPEEE"));
  return original(self, problem);
}

int nlopt_optimize(void* problem, double* x, double* value) {
  if (const char* status = std::getenv("NLOPT_FAULT")) return std::atoi(status);
  using Original = int (*)(void*, double*, double*);
  static const auto original = reinterpret_cast<Original>(dlsym(RTLD_NEXT, "nlopt_optimize"));
  return original(problem, x, value);
}
}
