// bench_thresholds DATASET.yaml EFFECT|none NAME...: perturbs each named threshold that the diagnosis of the
// dataset reads, and prints tab-separated lines: name, factor, "same" or "figures" or the new decision.
// EFFECT is taken out of the catalog. benchmarks/thresholds/run makes the datasets and adds up.
#include "diagnosis/thresholds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/result_files/write_diagnosis.hpp"

namespace joulepath {
namespace {

struct Answer {
  std::string decision{};  ///< verdict and names
  std::string text{};      ///< everything
  bool operator==(const Answer&) const = default;
};

class Campaign {
 public:
  Campaign(Dataset dataset, DiagnoseOptions options)
      : dataset_(std::move(dataset)), options_(std::move(options)), usual_(answer()) {
    std::printf("\tusual\t%s\n", usual_.decision.c_str());
  }

  /// All of them at once first: those that change nothing together are idle.
  void perturb(std::span<Threshold* const> some, double factor) const {
    std::vector<double> values;
    for (Threshold* threshold : some) {
      values.push_back(threshold->value);
      threshold->value = perturbed(*threshold, factor);
    }
    const Answer now = answer();
    for (std::size_t k = 0; k < some.size(); ++k) some[k]->value = values[k];
    if (now == usual_ || some.size() == 1) {
      const bool decided = now.decision != usual_.decision;
      for (const Threshold* threshold : some)
        std::printf("%s\t%g\t%s\n", threshold->name, factor,
                    decided         ? now.decision.c_str()
                    : now == usual_ ? "same"
                                    : "figures");
      std::fflush(stdout);
      return;
    }
    perturb(some.first(some.size() / 2), factor);
    perturb(some.subspan(some.size() / 2), factor);
  }

 private:
  Answer answer() const try {
    const Diagnosis diagnosis = diagnose(dataset_, options_);
    Answer answer{verdict_name(diagnosis.verdict), diagnosis_json(diagnosis)};
    for (const Cause& cause : diagnosis.causes) answer.decision += ' ' + cause.effect.name;
    return answer;
  } catch (const std::exception& error) {
    return {error.what(), ""};
  }

  static double perturbed(const Threshold& threshold, double factor) {
    const double value = threshold.value * factor;
    if (!threshold.whole) return value;
    return factor < 1 ? std::floor(value) : std::ceil(value);
  }

  Dataset dataset_;
  DiagnoseOptions options_;
  Answer usual_;
};

}  // namespace
}  // namespace joulepath

int main(int argc, char** argv) try {
  using namespace joulepath;
  if (argc < 3) return std::fputs("usage: bench_thresholds DATASET.yaml EFFECT|none NAME...\n", stderr), 2;
  DiagnoseOptions options;
  if (argv[2] != std::string("none")) options.without.insert(argv[2]);
  const Campaign campaign(read_dataset(argv[1], {.accept_implausible = true}), options);
  std::vector<Threshold*> read;
  for (Threshold& threshold : kThresholds)
    if (threshold.read && std::find(argv + 3, argv + argc, std::string(threshold.name)) != argv + argc)
      read.push_back(&threshold);
  if (read.empty()) return 0;
  for (const double factor : {0.7, 1.4}) campaign.perturb(read, factor);
  return 0;
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
