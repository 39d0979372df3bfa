#include "app/jobs/run_jobs.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/interrupt.hpp"
#include "app/jobs/journal.hpp"
#include "app/jobs/progress.hpp"
#include "model/config_error.hpp"
#include "model/printable.hpp"
#include "model/progress.hpp"
#include "model/workers.hpp"
#include "scenarios/text/counted.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

/// The result of a job that is not run.
JobResult quarantined(const JobList& jobs, std::size_t index, const std::string& reason) {
  auto line = nlohmann::ordered_json::parse(jobs.name_line(index));
  line["status"] = "quarantined";
  line["message"] = printable(reason);
  return {.index = index, .line = line.dump(), .status = "quarantined"};
}

/// The jobs of a shard: those with a result already, and the open ones.
struct ShardWork {
  std::vector<std::size_t> indices{};  ///< of the jobs; the other vectors go with it
  std::vector<JobResult> results{};
  std::vector<std::string> fingerprints{};
  std::vector<std::size_t> open{};  ///< places in `indices`
  std::size_t kept{};               ///< results of the journal that hold
};

ShardWork shard_work(JobList& jobs, const JobRun& run, const JobJournal& journal) {
  ShardWork work{.indices = run.shard.indices(jobs.size())};
  work.results.resize(work.indices.size());
  work.fingerprints.resize(work.indices.size());
  for (std::size_t i = 0; i < work.indices.size(); ++i) {
    const std::size_t index = work.indices[i];
    const auto held = run.quarantine.find(index);
    if (held != run.quarantine.end() || journal.has(index)) work.fingerprints[i] = jobs.fingerprint(index);
    const JobResult* earlier = journal.find(index, work.fingerprints[i]);
    if (held != run.quarantine.end()) {
      work.results[i] = quarantined(jobs, index, held->second);
    } else if (earlier != nullptr) {
      work.results[i] = *earlier;
      ++work.kept;
    } else {
      work.open.push_back(i);
    }
  }
  return work;
}

[[noreturn]] void refuse_unfinished(const std::string& file) {
  const auto earlier = run_of_journal(file);
  throw ConfigError({{file, 0, 0},
                     "",
                     "the results of an unfinished run" + (earlier ? " (" + earlier->text() + ")" : ""),
                     "--resume with the inputs of that run, which continues it; or another --out",
                     "--force deletes them and starts again"});
}

/// Throws ConfigError if the journal has results of another run. A list that was edited is the same run as
/// long as one of its results holds.
void check_same_run(const std::string& file, const JobJournal& journal, const JournalRun& run,
                    std::size_t kept) {
  if (journal.size() == 0) return;
  const auto& earlier = journal.run();
  if (earlier ? earlier->command == run.command && earlier->shard == run.shard &&
                    (earlier->list == run.list || (earlier->source == run.source && kept > 0))
              : kept > 0)
    return;
  const bool edited = earlier && earlier->text() == run.text();
  throw ConfigError(
      {{file, 0, 0},
       "",
       counted(journal.size(), "result") + " of another unfinished run" +
           (earlier ? " (" + earlier->text() + (edited ? " with other contents)" : ")") : ""),
       "an unfinished run of " + run.text(),
       "--resume with the inputs of that run continues it, another --out keeps it; --force instead "
       "of --resume deletes it"});
}

}  // namespace

std::optional<std::vector<JobResult>> run_job_list(JobList& jobs, const JobRun& run) {
  const std::string file = journal_file(run.directory);
  if (std::filesystem::exists(file) && !run.resume && !run.force) refuse_unfinished(file);
  if (run.part && run.resume && !run.force) run.part->check_finished(jobs, run);
  std::filesystem::create_directories(run.directory);
  JobJournal journal(file, run.resume ? JobJournal::Use::resume : JobJournal::Use::anew);
  ShardWork work = shard_work(jobs, run, journal);
  const JournalRun described{run.command, run.source, run.shard.text(), jobs.digest()};
  check_same_run(file, journal, described, work.kept);
  journal.begin(described);
  const PoliteInterrupt interrupt;
  {
    Progress progress(run.noun + (run.shard.is_whole() ? "" : " of shard " + run.shard.text()),
                      work.indices.size(), run.quiet, work.indices.size() - work.open.size());
    run_jobs(
        work.open, run.threads,
        [&](std::size_t i) {
          work.fingerprints[i] = jobs.fingerprint(work.indices[i]);  // before the job reads its files
          JobResult result = jobs.plan(work.indices[i]);
          result.index = i;
          return result;
        },
        [&](const JobResult& done) {
          JobResult& result = work.results[done.index] = done;
          result.index = work.indices[done.index];
          journal.add(result, std::exchange(work.fingerprints[done.index], {}));
          progress.advance();
        },
        [] { return PoliteInterrupt::requested(); });
  }
  if (!PoliteInterrupt::requested()) return std::move(work.results);
  std::cerr << "interrupted; --resume continues\n";
  return std::nullopt;
}

std::string journal_file(const std::string& directory) { return directory + "/results.partial.jsonl"; }

void remove_journal(const std::string& directory) { std::filesystem::remove(journal_file(directory)); }

void run_jobs(const std::vector<std::size_t>& indices, unsigned threads,
              const std::function<JobResult(std::size_t)>& work,
              const std::function<void(const JobResult&)>& done, const std::function<bool()>& stop) {
  std::mutex mutex;
  for_each_index(indices.size(), threads, [&](std::size_t k) {
    if (stop()) return;
    const JobResult result = [&] {
      const StepScope uncounted(nullptr);
      return work(indices[k]);
    }();
    const std::lock_guard lock(mutex);
    done(result);
  });
}

}  // namespace joulepath
