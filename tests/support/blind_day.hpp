#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "scenarios/log_files/dataset_file.hpp"
#include "tests/support/locations.hpp"

namespace joulepath::testing {

inline std::string blind_plant() { return std::string(JOULEPATH_BINARY_DIR) + "/bin/blind_plant"; }
inline bool have_blind_plant() { return std::filesystem::exists(blind_plant()); }

/// A test day of the benchmark's plant, which shares no code with the diagnosis: separate wheel bodies,
/// electrical states, a controller, its own integrator. `options`: of blind_plant, without --out.
inline Dataset blind_day(const std::string& options) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / ("blind_day_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  const std::string command = blind_plant() + " " + options + " --out " + folder.string() + " > /dev/null";
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
  Dataset dataset = read_dataset((folder / "dataset.yaml").string());
  std::filesystem::remove_all(folder);
  return dataset;
}

/// `size` 0: a random size.
inline Dataset blind_day(const std::string& effect, double size, int level, int runs, int seed) {
  return blind_day("--effect " + effect + (size != 0 ? " --size " + std::to_string(size) : "") + " --level " +
                   std::to_string(level) + " --protocol " + std::to_string(runs) + " --seed " +
                   std::to_string(seed));
}

}  // namespace joulepath::testing
