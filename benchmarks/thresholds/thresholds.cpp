// bench_thresholds DATASET.yaml [EFFECT]: perturbs each threshold that the diagnosis of the dataset reads,
// one at a time, and prints as tab-separated lines: name, direction, and the answer where it differs. EFFECT
// is taken out of the catalog. benchmarks/thresholds/run makes the datasets and adds up.
#include "diagnosis/thresholds.hpp"

#include <cmath>
#include <cstdio>
#include <exception>

#include "scenarios/dataset_file.hpp"
#include "scenarios/write_diagnosis.hpp"

namespace joulepath {
namespace {

constexpr double kDown = 0.7, kUp = 1.4;

struct Answer {
  std::string decision{};  ///< verdict and names
  std::string text{};      ///< everything
  bool operator==(const Answer&) const = default;
};

Answer answer_of(const Dataset& dataset, const DiagnoseOptions& options) try {
  const Diagnosis diagnosis = diagnose(dataset, options);
  Answer answer{verdict_name(diagnosis.verdict), diagnosis_json(diagnosis)};
  for (const Cause& cause : diagnosis.causes) answer.decision += ' ' + cause.effect.name;
  return answer;
} catch (const std::exception& error) {
  return {error.what(), ""};
}

double perturbed(const Threshold& threshold, double factor) {
  const double value = threshold.value * factor;
  if (!threshold.whole) return value;
  return factor < 1 ? std::floor(value) : std::ceil(value);
}

void campaign(const Dataset& dataset, const DiagnoseOptions& options) {
  const Answer usual = answer_of(dataset, options);
  std::printf("\tusual\t%s\n", usual.decision.c_str());
  for (Threshold& threshold : kThresholds) {
    if (!threshold.read) continue;
    for (const double factor : {kDown, kUp}) {
      const double value = threshold.value;
      threshold.value = perturbed(threshold, factor);
      const Answer now = answer_of(dataset, options);
      threshold.value = value;
      const bool decided = now.decision != usual.decision;
      std::printf("%s\t%s\t%s\n", threshold.name, factor < 1 ? "down" : "up",
                  decided        ? now.decision.c_str()
                  : now == usual ? "same"
                                 : "figures");
    }
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) try {
  if (argc < 2) return std::fputs("usage: bench_thresholds DATASET.yaml [EFFECT]\n", stderr), 2;
  joulepath::DiagnoseOptions options;
  if (argc > 2) options.without.insert(argv[2]);
  joulepath::campaign(joulepath::read_dataset(argv[1], {.accept_implausible = true}), options);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
