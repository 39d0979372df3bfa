#include <algorithm>
#include <filesystem>
#include <sstream>

#include "app/command_line.hpp"
#include "app/jobs/content_hash.hpp"
#include "app/jobs/job_results.hpp"
#include "extensions/studies/commands/shard_manifest.hpp"
#include "extensions/studies/commands/sweep_output.hpp"

namespace joulepath {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& found, const std::string& accepted) {
  throw ConfigError({{file, 0, 0}, "", found, accepted, "run this shard again"});
}

/// Puts the lines of a shard's file at the indices of their jobs.
void take_lines(const std::string& file, const std::string& text, const ShardManifest& manifest,
                std::vector<std::string>& all) {
  const std::vector<std::size_t> indices = manifest.shard.indices(manifest.jobs);
  const auto count = static_cast<std::size_t>(std::ranges::count(text, '\n'));
  if (count != indices.size())
    refuse(file, std::to_string(count) + " lines", std::to_string(indices.size()) + " lines");
  std::istringstream lines(text);
  for (const std::size_t index : indices) std::getline(lines, all[index]);
}

void take_results(const std::string& directory, const ShardManifest& manifest,
                  std::vector<std::string>& all) {
  const std::string file = directory + "/results.jsonl", text = read_text_file(file);
  if (ContentHash().mix(text).text() != manifest.results_digest)
    refuse(file, "lines that were changed or cut", "the lines that the shard wrote");
  take_lines(file, text, manifest, all);
}

class MergeCommand : public Command {
 public:
  MergeCommand()
      : Command({.name = "merge",
                 .says = "join the shards of a batch or a sweep",
                 .examples =
                     "  joulepath merge out/shard_1 out/shard_2 --out out/batch\n\n"
                     "The results have the same bytes as those of one run on the same day. Shards of other "
                     "inputs or of\nanother build of the program are rejected, and so are an incomplete set "
                     "and results that were changed\nafter the run.\n"}) {}

  void declare(CommandLine& line) override {
    line.option("DIR", directories_, "directories written with --shard").required().existing_path();
    line.option("--out", out_, "directory for the results of the whole run").required();
    add_common_flags(line, common_, "qjf");
  }

  int run() override {
    std::vector<ShardManifest> shards;
    for (const std::string& directory : directories_) {
      shards.push_back(read_manifest(directory));
      std::error_code absent;
      if (std::filesystem::equivalent(directory, out_, absent))
        throw ConfigError({{out_, 0, 0}, "--out", "the directory of a shard", "a directory of its own"});
    }
    check_complete(directories_, shards);
    const ShardManifest& first = shards.front();
    OutputDirectory out(out_, first.command == "sweep" ? kSweepFiles : kBatchFiles, common_.force);
    std::vector<std::string> lines(first.jobs);
    for (std::size_t i = 0; i < shards.size(); ++i) take_results(directories_[i], shards[i], lines);
    add_merged_timings(out, first.jobs, shards);
    if (first.command == "sweep")
      finish_sweep(out, study_from(Document::parse(first.study_text, first.study_file)), lines, {}, common_);
    else
      static_cast<void>(finish_batch(out, first.title, lines, common_));  // merged, whatever the lines say
    return kDone;
  }

 private:
  /// The shards' timings in the order of the jobs.
  void add_merged_timings(OutputDirectory& out, std::size_t jobs,
                          const std::vector<ShardManifest>& shards) const {
    std::vector<std::string> timings(jobs);
    for (std::size_t i = 0; i < shards.size(); ++i) {
      const std::string file = directories_[i] + "/timings.jsonl";
      take_lines(file, read_text_file(file), shards[i], timings);
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
