#pragma once

#include <map>
#include <string>
#include <vector>

namespace joulepath {

/// The results of one command in one directory. commit() writes the files under temporary names beside the
/// directory and renames them, so a killed run leaves no half file. Before commit() nothing changes.
class OutputDirectory {
 public:
  /// `names`: every file that the command may write. Throws ConfigError if one of them exists and `force` is
  /// not given; with it, commit() removes those that the new results do not have (a stale trajectory.csv).
  OutputDirectory(const std::string& directory, std::vector<std::string> names, bool force);

  /// Adds one file; its name must be one of `names`.
  void write(const std::string& name, std::string content);

  /// Writes all. Throws EnvironmentError (disk full, no permission), or ConfigError where a file is an input
  /// of the command; the directory is then unchanged.
  void commit();

  [[nodiscard]] const std::string& path() const { return directory_; }

 private:
  std::string directory_;
  std::vector<std::string> names_;
  std::map<std::string, std::string> content_{};
};

/// Writes one file under a temporary name and renames it. Throws ConfigError if it exists and `force` is not
/// given, or if it is an input of the command; EnvironmentError if it cannot be written.
void write_output_file(const std::string& file, const std::string& content, bool force);

/// Removes a result of an earlier run, where there is one; whether there was. Throws as write_output_file()
/// does.
bool remove_output_file(const std::string& file);

/// The same for a file that the user edits, an input or not: a symbolic link stays one, and the file keeps
/// its mode. A file that the user may not write is refused.
void replace_file(const std::string& file, const std::string& content);

}  // namespace joulepath
