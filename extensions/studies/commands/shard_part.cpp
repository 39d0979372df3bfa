#include <nlohmann/json.hpp>

#include "app/build_id.hpp"
#include "app/command_line.hpp"
#include "app/jobs/content_hash.hpp"
#include "app/jobs/job_part.hpp"
#include "app/jobs/job_results.hpp"
#include "extensions/studies/commands/quarantine.hpp"
#include "extensions/studies/commands/shard_manifest.hpp"

namespace joulepath {
namespace {

/// Every N-th job from the K-th on, in a directory for `joulepath merge`.
class ShardPart : public JobPart {
 public:
  [[nodiscard]] std::string example() const override {
    return "missions.jsonl --out shard_2 --shard 2/8   # then: joulepath merge shard_* --out all";
  }

  void declare(CommandLine& line) override {
    line.option("--shard", shard_,
                "K/N: plan only every N-th one, from the K-th on; `joulepath merge` joins the N directories");
    line.option("--quarantine", quarantine_,
                "file of JSON lines {index, reason}: jobs to skip, because they ended their process");
  }

  void choose(JobRun& run) const override {
    run.shard = shard_from(shard_);
    run.quarantine = read_quarantine(quarantine_);
    run.part = run.shard.is_whole() ? nullptr : this;
  }

  [[nodiscard]] const std::vector<std::string>& files() const override {
    static const std::vector<std::string> names{"results.jsonl", "timings.jsonl", "shard.json"};
    return names;
  }

  void check_finished(const JobList& jobs, const JobRun& run) const override {
    if (!has_manifest(run.directory)) return;
    const ShardManifest finished = read_manifest(run.directory);
    forget_input(run.directory + "/shard.json");  // this run replaces it
    if (finished.command == run.command && finished.shard.text() == run.shard.text() &&
        finished.list_digest == jobs.digest())
      return;
    throw ConfigError(
        {{run.directory, 0, 0},
         "",
         "the finished shard " + finished.shard.text() + " of another " + finished.command,
         "a directory without results, or those of shard " + run.shard.text() + " of this " + run.command,
         "--force overwrites it"});
  }

  void write(OutputDirectory& out, const JobList& jobs, const std::vector<JobResult>& results,
             const JobRun& run, const JobTitle& about) const override {
    const std::string lines = joined(lines_of(results));
    const ShardManifest manifest{.command = run.command,
                                 .version = JOULEPATH_VERSION,
                                 .build = std::string(kBuildId),
                                 .shard = run.shard,
                                 .jobs = jobs.size(),
                                 .title = about.title,
                                 .options = jobs.options(),
                                 .list_digest = jobs.digest(),
                                 .files = jobs.files_read(),
                                 .results_digest = ContentHash().mix(lines).text(),
                                 .study_file = about.study_file,
                                 .study_text = about.study_text};
    out.write("results.jsonl", lines);
    add_timings(out, results);
    out.write("shard.json", manifest_text(manifest));
    out.commit();
  }

 private:
  std::string shard_{};
  std::string quarantine_{};
};

}  // namespace

std::unique_ptr<JobPart> make_shard_part() { return std::make_unique<ShardPart>(); }

}  // namespace joulepath
