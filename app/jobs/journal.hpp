#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "app/jobs/run_jobs.hpp"

namespace joulepath {

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

  /// Throws EnvironmentError when the line cannot be written completely.
  void add(const JobResult& result, const std::string& fingerprint);

  /// The earlier result of a mission if its fingerprint is the same and not empty.
  [[nodiscard]] const JobResult* find(std::size_t index, const std::string& fingerprint) const;

  /// Deletes the journal after the results were written.
  void remove();

 private:
  struct Entry {
    std::string fingerprint{};
    JobResult result{};
  };

  void read();
  void append(const std::string& text);

  std::string file_;
  int descriptor_{-1};
  std::map<std::size_t, Entry> earlier_{};
};

}  // namespace joulepath
