#pragma once

#include <array>
#include <cstddef>

namespace joulepath {

enum class Verdict {
  no_gap,
  explained,
  partly_explained,
  unexplained,
  ambiguous,
  too_little_data,
  data_suspect
};

/// The words of a verdict.
struct VerdictWords {
  const char* name;  ///< in diagnosis.json
  const char* title;
  const char* meaning;    ///< one or two sentences
  const char* next_step;  ///< one sentence
  bool good;              ///< nothing is left to find out
};

/// In the order of Verdict. The terminal, the sentence of a diagnosis, its pages and its schema read this
/// table.
inline constexpr std::array<VerdictWords, 7> kVerdicts{
    {{"no_gap", "No gap", "Calibration errors and noise explain the runs.", "The model needs no correction.",
      true},
     {"explained", "Explained", "The effects below explain the gap.", "Plan with the corrected files.", true},
     {"partly_explained", "Partly explained",
      "The effects below explain a part of the gap. The rest is unknown.", "Plan with the corrected files.",
      false},
     {"unexplained", "Unexplained", "No effect of the catalog fits.", "Nothing is corrected.", false},
     {"ambiguous", "Ambiguous", "These runs cannot separate the effects below.", "Drive the proposed run.",
      false},
     {"too_little_data", "Too little data", "The runs name no cause and give no all-clear.",
      "Log more runs and channels: the notes list what is missing.", false},
     {"data_suspect", "Suspect data", "Channels of the log contradict physics.", "Repair the dataset first.",
      false}}};

constexpr const VerdictWords& words_of(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}
constexpr const char* verdict_name(Verdict verdict) { return words_of(verdict).name; }

}  // namespace joulepath
