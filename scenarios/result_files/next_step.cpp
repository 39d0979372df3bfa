#include "scenarios/result_files/next_step.hpp"

#include "model/text_of_list.hpp"
#include "scenarios/result_files/diagnosis_sentence.hpp"

namespace joulepath {
namespace {

constexpr const char* kLogMore = words_of(Verdict::too_little_data).next_step;

bool is_corrected(const Diagnosis& d) { return d.corrected_robot || !d.corrected_instruments.empty(); }

/// Why nothing is written although effects are named.
std::string not_written(const Diagnosis& d) {
  return d.refused_correction.empty()
             ? "No correction shrinks the gap on held-out runs: none is written."
             : "No correction is written, as its robot file would be refused: " + d.refused_correction + ".";
}

/// Where to look for what no effect explains.
std::string examine(const Diagnosis& d) {
  std::vector<std::string> quantities;
  for (const UnknownCause& unknown : d.unknowns) quantities.push_back(unknown.depends_on);
  return quantities.empty() ? "Look at the runs and places with the largest shares of the gap."
                            : "Examine the robot where the gap depends on " + text_of_list(quantities) + ".";
}

/// What to do about the model of the robot file.
std::string step_of_file(const Diagnosis& d) {
  const std::string step = words_of(d.verdict).next_step;
  if (!d.foreign_constants.empty())
    return step + " Name this robot's file, or correct these constants in it.";
  switch (d.verdict) {
    case Verdict::explained:
      return is_corrected(d) ? step : not_written(d);
    case Verdict::partly_explained:
      return (is_corrected(d) ? step : not_written(d)) + " " + examine(d);
    case Verdict::unexplained:
      return step + " " + examine(d);
    case Verdict::ambiguous:
      return d.next.motions.empty() ? kLogMore : step;
    case Verdict::data_suspect:
      return step + " joulepath check DATASET --repair FILE writes it repaired.";
    case Verdict::no_gap:
    case Verdict::too_little_data:
      return step;
  }
  return step;
}

/// What to do about the user's own simulator.
std::string step_by_verdict(const Diagnosis& d) {
  if (d.simulator.runs == 0) return step_of_file(d);
  switch (d.verdict) {
    case Verdict::no_gap:
      return "The simulator needs no correction.";
    case Verdict::explained:
      return "Add these causes to the simulator.";
    case Verdict::partly_explained:
      return "Add these causes to the simulator. " + examine(d);
    default:
      return step_of_file(d);
  }
}

}  // namespace

std::string next_step(const Diagnosis& d) {
  if (d.runs_apart.empty()) return step_by_verdict(d);
  return step_by_verdict(d) + " Find out what was different in " +
         text_of_list(d.runs_apart, &RunApart::run) + ".";
}

}  // namespace joulepath
