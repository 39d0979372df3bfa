#include <fstream>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/jobs/finish.hpp"

namespace joulepath {
namespace {

[[noreturn]] void refuse_line(const std::string& file, int line, const std::string& found,
                              const std::string& accepted) {
  throw ConfigError({{file, line, 0}, "", found, accepted, "run this shard again"});
}

/// Puts the lines of one shard at their indices.
void take_lines(const std::string& directory, const ShardManifest& manifest, std::vector<std::string>& all) {
  const std::string file = directory + "/results.jsonl";
  const std::vector<std::size_t> indices = manifest.shard.indices(manifest.jobs);
  std::ifstream in(file);
  std::size_t count = 0;
  for (std::string line; std::getline(in, line); ++count) {
    const int number = static_cast<int>(count) + 1;
    if (count >= indices.size())
      refuse_line(file, number, "a line too many", std::to_string(indices.size()) + " lines");
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("status") || json.value("index", json) != indices[count])
      refuse_line(file, number, "no result of job " + std::to_string(indices[count]),
                  "the shard's own lines");
    all[indices[count]] = std::move(line);
  }
  if (count < indices.size())
    refuse_line(file, 0, std::to_string(count) + " lines", std::to_string(indices.size()) + " lines");
}

class MergeCommand : public Command {
 public:
  MergeCommand()
      : Command({.name = "merge",
                 .says = "join the shards of a batch or a sweep",
                 .examples =
                     "  joulepath merge out/shard_1 out/shard_2 --out out/batch\n\n"
                     "The results have the same bytes as those of one run. Shards of other inputs or of "
                     "another version of the\nprogram are rejected, and so is an incomplete set.\n"}) {}

  void declare(CommandLine& line) override {
    line.option("DIR", directories_, "directories written with --shard").required().existing_path();
    line.option("--out", out_, "directory for the results of the whole run").required();
    add_common_flags(line, common_, "qjf");
  }

  int run() override {
    std::vector<ShardManifest> shards;
    for (const std::string& directory : directories_) shards.push_back(read_manifest(directory));
    check_complete(directories_, shards);
    const ShardManifest& first = shards.front();
    OutputDirectory out(out_, first.command == "sweep" ? kSweepFiles : kBatchFiles, common_.force);
    std::vector<std::string> lines(first.jobs);
    for (std::size_t i = 0; i < shards.size(); ++i) take_lines(directories_[i], shards[i], lines);
    add_merged_timings(out, first.jobs, shards);
    if (first.command == "sweep")
      finish_sweep(out, study_from(Document::parse(first.study_text, first.study_file)), lines, {}, common_);
    else
      finish_batch(out, first.title, lines, common_);
    return kDone;
  }

 private:
  /// The shards' timings in the order of the jobs.
  void add_merged_timings(OutputDirectory& out, std::size_t jobs,
                          const std::vector<ShardManifest>& shards) const {
    std::vector<std::string> timings(jobs);
    for (std::size_t i = 0; i < shards.size(); ++i) {
      std::ifstream in(directories_[i] + "/timings.jsonl");
      for (const std::size_t index : shards[i].shard.indices(jobs)) std::getline(in, timings[index]);
    }
    std::string text;
    for (const std::string& line : timings) text += line + "\n";
    out.write("timings.jsonl", text);
  }

  std::vector<std::string> directories_{};
  std::string out_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_merge_command() { return std::make_unique<MergeCommand>(); }

}  // namespace joulepath
