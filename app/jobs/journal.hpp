#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

#include "app/jobs/run_jobs.hpp"

namespace joulepath {

/// The run that a journal belongs to. Design: docs/decisions/0700-results-and-jobs.md
struct JournalRun {
  std::string command{};  ///< batch or sweep
  std::string source{};   ///< absolute name of the missions or of the study
  std::string shard{};    ///< 2/8; empty: the whole
  std::string list{};     ///< digest of the jobs without the files that they name

  bool operator==(const JournalRun&) const = default;
  [[nodiscard]] std::string text() const;  ///< as a command: joulepath sweep /studies/gear.yaml --shard 2/8
};

/// The run of a journal that another process may be writing; none: unknown.
[[nodiscard]] std::optional<JournalRun> run_of_journal(const std::string& file);

/// The results of jobs in the order of their completion, one JSON line each, appended and synced to the disk,
/// so that they survive a kill. Existing lines are never changed. Only one program at a time may write a
/// journal.
class JobJournal {
 public:
  enum class Use { anew, resume };

  /// With `resume`, the results of an earlier run are read. With `anew`, an earlier journal is deleted; the
  /// caller must check that this is allowed. Throws EnvironmentError.
  JobJournal(std::string file, Use use);
  ~JobJournal();
  JobJournal(const JobJournal&) = delete;
  JobJournal& operator=(const JobJournal&) = delete;

  /// The run that the journal belongs to; none: it is empty, or its first line was cut.
  [[nodiscard]] const std::optional<JournalRun>& run() const { return run_; }
  [[nodiscard]] std::size_t size() const { return earlier_.size(); }
  [[nodiscard]] bool has(std::size_t index) const { return earlier_.contains(index); }

  /// Makes it the journal of this run. Throws EnvironmentError.
  void begin(const JournalRun& run);

  /// Throws EnvironmentError when the line cannot be written completely.
  void add(const JobResult& result, const std::string& fingerprint);

  /// The earlier result of a mission if its fingerprint is the same and not empty.
  [[nodiscard]] const JobResult* find(std::size_t index, const std::string& fingerprint) const;

 private:
  struct Entry {
    std::string fingerprint{};
    JobResult result{};
  };

  void read();
  void append(const std::string& text);

  std::string file_;
  int descriptor_{-1};
  std::optional<JournalRun> run_{};
  std::map<std::size_t, Entry> earlier_{};
};

}  // namespace joulepath
