#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/values/simulator_deviation.hpp"
#include "model/config_error.hpp"
#include "model/prescribed_motion.hpp"
#include "model/robot.hpp"
#include "model/trajectory.hpp"

namespace joulepath {

/// Payload from this time of the run onwards.
struct PayloadStep {
  double from_s{};
  double payload_kg{};
};

/// A property of a log that is not physics: held values, clock jumps, wrapped counters, ignored columns.
struct LogArtifact {
  std::string kind{};     ///< clock_jump | gap | held_value | wrapped | unsigned | ignored_columns |
                          ///< missing_values | resampled | contradiction | cut | partial_channel
  std::string run{};      ///< name of the run, empty = the whole dataset
  std::string channel{};  ///< column, empty = all
  std::string description{};
  std::size_t count{};  ///< samples or events
  double first_time_s{};
};

enum class RunUse { any, diagnosis, validation };

/// One run: a log with its conditions, or a prescribed motion with measured energies.
struct Run {
  std::string name{};  ///< the file as named in the dataset; `runs[3]` for a run with energies only
  Trajectory log{};    ///< payload_kg only where it changes; empty for a run with energies only
  std::optional<Trajectory> predicted{};          ///< another simulator's prediction, its own time base
  std::optional<SimulatorDeviation> deviation{};  ///< of `predicted` from the model; the model has it added
  std::optional<PrescribedMotion> motion{};
  std::optional<Sided<double>> measured_energy_J{};
  std::optional<double> battery_energy_Wh{};
  std::vector<PayloadStep> payload{};  ///< in order of time; one entry = constant
  bool payload_known{};  ///< false: neither the dataset nor the log states a payload; `payload` is a guess
  std::string surface{};
  std::optional<double> start_time_s{};  ///< time of day
  double clock_origin_s{};               ///< what an epoch clock read at time 0 of the log; 0: no such clock
  double velocity_filter_s{};            ///< time constant of a filter behind which the speeds are; 0: none
  double predicted_filter_s{};           ///< the same of `predicted`
  RunUse use{RunUse::any};
  bool wheels_from_body_speeds{};   ///< the log has only the speeds of the body
  bool current_sign_from_motion{};  ///< the log's currents are unsigned; the sign comes from the wheel's
                                    ///< motion
  SourceMark mark{};
};

struct Dataset {
  std::string file{};
  std::string robot_file{};  ///< empty: the dataset names none
  Robot robot{};
  std::vector<Run> runs{};
  std::vector<LogArtifact> artifacts{};
};

}  // namespace joulepath
