// One libFuzzer target for each kind of input: FUZZ_KIND=robot|mission|... chooses the reader. Datasets and
// logs that are read are checked and diagnosed, too, with FUZZ_DIAGNOSE=1 and where they are short. An input
// is right, or it is refused with a ConfigError; anything else (crash, sanitizer report, other exception,
// more time or memory than the limits of ./dev fuzz) is a finding. Another value lists the targets.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <string>

#include "app/command.hpp"
#include "app/jobs/journal.hpp"
#include "diagnosis/checks/data_checks.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "scenarios/any_file.hpp"
#include "scenarios/log_files/dataset_file.hpp"

namespace {

namespace fs = std::filesystem;

struct Target {
  std::string file{};  ///< name under which the input is read
  std::string kind{};  ///< as `joulepath check --kind`; empty: told by the content
  std::string read{};  ///< the file that names the input, where it is not read itself
};

const std::map<std::string, Target>& targets() {
  static const std::map<std::string, Target> all{{"robot", {"input.yaml", "robot", {}}},
                                                 {"mission", {"input.yaml", "mission", {}}},
                                                 {"dataset", {"input.yaml", "dataset", {}}},
                                                 {"fleet", {"input.yaml", "fleet", {}}},
                                                 {"study", {"input.yaml", "study", {}}},
                                                 {"map", {"input.yaml", "map", {}}},
                                                 {"pgm", {"input.pgm", "map", "pgm_map.yaml"}},
                                                 {"png", {"input.png", "map", "png_map.yaml"}},
                                                 {"log", {"input.csv", "run log", {}}},
                                                 {"waypoints", {"input.csv", "path", {}}},
                                                 {"path", {"input.yaml", "path", {}}},
                                                 {"order", {"input.json", "", {}}},
                                                 {"graph", {"input.geojson", "route graph", {}}},
                                                 {"plan", {"input.json", "plan", {}}},
                                                 {"model", {"input.xml", "", {}}},
                                                 {"bag", {"input.mcap", "bag", {}}},
                                                 {"rosbag", {"input.db3", "bag", {}}},
                                                 {"states", {"input.jsonl", "bag", {}}},
                                                 {"journal", {"input.jsonl", "", {}}}};
  return all;
}

/// A scratch folder in memory, with a right file of each kind in ../good, as the files of tests/data/broken
/// name it.
struct Scratch {
  fs::path folder{fs::temp_directory_path() / ("joulepath_fuzz_" + std::to_string(::getpid()))};

  Scratch() {
    fs::remove_all(folder);
    fs::create_directories(folder / "in");
    fs::copy(JOULEPATH_GOOD_FILES, folder / "good");
    for (const std::string image : {"pgm", "png"})
      std::ofstream(folder / "in" / (image + "_map.yaml"))
          << "image: input." << image << "\nmode: scale\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
          << "occupied_thresh: 0.65\nfree_thresh: 0.25\n";
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { fs::remove_all(folder); }
};

std::string in_scratch(const std::string& file) {
  static const Scratch scratch;
  return scratch.folder / "in" / file;
}

const Target& chosen() {
  static const Target& target = [&]() -> const Target& {
    const char* kind = std::getenv("FUZZ_KIND");
    const auto found = targets().find(kind == nullptr ? "" : kind);
    if (found != targets().end()) return found->second;
    for (const auto& [name, unused] : targets()) std::cout << name << '\n';
    std::exit(2);
  }();
  return target;
}

double cpu_time_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What `fuzz/run` reads at the end. CPU time: a loaded machine does not change it.
struct Figures {
  std::uint64_t inputs{};
  double worst_input_s{};  ///< CPU time of the slowest input

  ~Figures() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::fprintf(stderr, "figures: %llu inputs, %.3f s CPU, worst input %.4f s, peak %.1f MiB\n",
                 static_cast<unsigned long long>(inputs), cpu_time_s(), worst_input_s,
                 static_cast<double>(used.ru_maxrss) / 1024);
  }
};

void read_as(const std::string& kind, const std::string& input) {
  static const std::string read = chosen().read.empty() ? input : in_scratch(chosen().read);
  try {
    if (kind.empty() && chosen().file == "input.jsonl")
      joulepath::JobJournal(input, joulepath::JobJournal::Use::resume).add({.line = "{}"}, "0");
    else
      static_cast<void>(joulepath::read_any_file(read, kind));
  } catch (const joulepath::ConfigError&) {
  }
}

/// Checks and diagnoses the dataset, or the log with a right robot, as the commands do. Work grows with the
/// samples: longer ones are left to the readers.
void diagnose_as_commands_do(const std::string& input) {
  constexpr std::size_t kMostSamples = 500;
  static const std::string robot = in_scratch("../good/robot.yaml");
  try {
    const joulepath::Dataset dataset = joulepath::read_dataset_or_log(
        input, {.cut_long_logs = true, .accept_implausible = true}, chosen().kind == "dataset" ? "" : robot);
    std::size_t samples = 0;
    for (const joulepath::Run& run : dataset.runs) samples += run.log.size();
    if (samples > kMostSamples) return;
    static_cast<void>(joulepath::check_data(dataset, joulepath::sort_runs(dataset)));
    static_cast<void>(joulepath::diagnose(dataset, {.bootstrap = 5}));
  } catch (const joulepath::ConfigError&) {
  }
}

/// A bag is read twice: its topics, then the run in it.
void read_as_chosen(const std::string& input) {
  read_as(chosen().kind, input);
  if (chosen().kind == "bag") read_as("run log", input);
  if (std::getenv("FUZZ_DIAGNOSE") && (chosen().kind == "dataset" || chosen().kind == "run log"))
    diagnose_as_commands_do(input);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  static_cast<void>(chosen());
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string input = in_scratch(chosen().file);
  static Figures figures;
  std::ofstream(input, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  const double start_s = cpu_time_s();
  read_as_chosen(input);
  figures.worst_input_s = std::max(figures.worst_input_s, cpu_time_s() - start_s);
  ++figures.inputs;
  return 0;
}
