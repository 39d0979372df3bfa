#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "app/commands/batch_run.hpp"

namespace joulepath {

/// The results of a batch in the order in which they come, one JSON line each, appended and synced to the
/// disk: what survives a kill. Lines that are there already are never changed. One program at a time may
/// write a journal.
class BatchJournal {
 public:
  enum class Use { anew, resume };

  /// With `resume`, the results of an earlier run are read. With `anew`, an earlier journal is deleted; the
  /// caller has asked whether it may be. Throws EnvironmentError.
  BatchJournal(std::string file, Use use);
  ~BatchJournal();
  BatchJournal(const BatchJournal&) = delete;
  BatchJournal& operator=(const BatchJournal&) = delete;

  /// Throws EnvironmentError when the line cannot be written whole.
  void add(const BatchResult& result, const std::string& fingerprint);

  /// The earlier result of a mission if its fingerprint is the same and not empty.
  [[nodiscard]] const BatchResult* find(std::size_t index, const std::string& fingerprint) const;

  /// Deletes the file: all results are in their place.
  void remove();

 private:
  struct Entry {
    std::string fingerprint{};
    BatchResult result{};
  };

  void read();
  void append(const std::string& text);

  std::string file_;
  int descriptor_{-1};
  std::map<std::size_t, Entry> earlier_{};
};

}  // namespace joulepath
