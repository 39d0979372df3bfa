#pragma once

#include <string>

#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

/// The result of a diagnosis in one line: verdict, causes with their sizes and probabilities, and the change
/// of the gaps. Every number is one of diagnosis.json; a gap "shrinks" where its numbers do by what counts.
[[nodiscard]] std::string diagnosis_sentence(const Diagnosis& diagnosis);

/// "The wheel speeds are behind a filter of 0.08 s; ...": or empty.
[[nodiscard]] std::string velocity_filter_words(const Diagnosis& diagnosis);

/// "Left out: run_07.csv, whose energy is 51 % above ...": the runs that the answer does not count; or empty.
[[nodiscard]] std::string runs_apart_words(const Diagnosis& diagnosis);

/// What the user's own simulator contains beyond the robot file, how its runs were aligned and what they
/// lack; or empty.
[[nodiscard]] std::string simulator_words(const Diagnosis& diagnosis);

/// What the verdict means, in one or two sentences.
[[nodiscard]] std::string diagnosis_meaning(const Diagnosis& diagnosis);

/// "is robot.yaml the right robot file? ...": of runs whose constants, or whose faults, look like those of
/// another robot; or empty.
[[nodiscard]] std::string right_robot_question(const std::string& robot_file,
                                               const std::vector<ForeignConstant>& constants,
                                               const std::vector<DataCheck>& checks);

}  // namespace joulepath
