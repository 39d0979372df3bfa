#include "app/output_directory.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>

#include "app/command.hpp"
#include "model/assert.hpp"
#include "model/config_error.hpp"
#include "scenarios/text/document.hpp"
// Design: docs/decisions/0700-results-and-jobs.md
namespace joulepath {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& doing, const std::string& reason) {
  throw EnvironmentError("cannot " + doing + " " + path.string() + ": " + reason);
}

void refuse_existing(const fs::path& path) {
  throw ConfigError({{path.string(), 0, 0}, "", "a file that exists", "a new name", "--force overwrites it"});
}

void refuse_input(const fs::path& path) {
  if (is_input(path.string()))
    throw ConfigError({{path.string(), 0, 0}, "--out", "an input of this command", "a name of its own", ""});
}

/// Writes a whole file. A new one gets this mode, less the process's mask.
void write_whole(const fs::path& path, const std::string& content, mode_t mode = 0644) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode);
  if (file < 0) fail(path, "write", std::strerror(errno));
  std::size_t done = 0;
  while (done < content.size()) {
    const auto written = ::write(file, content.data() + done, content.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const std::string reason = std::strerror(errno);
      ::close(file);
      fail(path, "write", reason);
    }
    done += static_cast<std::size_t>(written);
  }
  if (::close(file) != 0) fail(path, "write", std::strerror(errno));
}

void rename_over(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) fail(to, "write", error.message());
}

/// A directory that is removed at the end of the scope.
class TemporaryDirectory {
 public:
  explicit TemporaryDirectory(const fs::path& beside)
      : path_(beside.parent_path() /
              ("." + beside.filename().string() + ".part-" + std::to_string(::getpid()))) {
    std::error_code error;
    if (!beside.parent_path().empty()) fs::create_directories(beside.parent_path(), error);
    if (!error) fs::create_directory(path_, error);
    if (error) fail(path_, "create", error.message());
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Throws EnvironmentError if a file cannot be created in the directory, or the directory itself.
void check_writable(const fs::path& directory) {
  std::error_code error;
  fs::path nearest = fs::absolute(directory, error);
  while (!fs::exists(nearest, error) && nearest.has_relative_path()) nearest = nearest.parent_path();
  if (!fs::is_directory(nearest, error)) fail(directory, "create", nearest.string() + " is no directory");
  if (::access(nearest.c_str(), W_OK | X_OK) != 0) fail(directory, "write", std::strerror(errno));
}

fs::path without_trailing_slash(const std::string& directory) {
  fs::path path = fs::path(directory).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

/// `mode`: of a file that is replaced.
void rename_into_place(const fs::path& target, const std::string& content, std::optional<mode_t> mode = {}) {
  const TemporaryDirectory temporary(target);
  const fs::path part = temporary.path() / target.filename();
  write_whole(part, content, mode ? mode_t{0600} : mode_t{0644});
  if (mode && ::chmod(part.c_str(), *mode) != 0) fail(target, "write", std::strerror(errno));
  rename_over(part, target);
}

}  // namespace

OutputDirectory::OutputDirectory(const std::string& directory, std::vector<std::string> names, bool force)
    : directory_(without_trailing_slash(directory).string()), names_(std::move(names)) {
  if (directory_.empty()) throw UsageError("--out needs a directory");
  std::error_code error;
  if (fs::exists(directory_, error) && !fs::is_directory(directory_, error))
    throw ConfigError({{directory_, 0, 0}, "", "a file", "a directory for the results", ""});
  if (!names_.empty()) check_writable(directory_);
  if (force) return;
  for (const auto& name : names_)
    if (fs::exists(fs::path(directory_) / name, error)) refuse_existing(fs::path(directory_) / name);
}

void OutputDirectory::write(const std::string& name, std::string content) {
  JOULEPATH_ASSERT(std::find(names_.begin(), names_.end(), name) != names_.end(),
                   "output file not announced: " + name);
  content_[name] = std::move(content);
}

void OutputDirectory::commit() {
  const fs::path target = directory_;
  for (const auto& name : names_) refuse_input(target / name);
  const TemporaryDirectory temporary(target);
  for (const auto& [name, content] : content_) write_whole(temporary.path() / name, content);
  std::error_code error;
  fs::create_directories(target, error);
  if (error) fail(target, "create", error.message());
  for (const auto& name : names_)
    if (!content_.contains(name)) {
      fs::remove(target / name, error);
      if (error) fail(target / name, "remove", error.message());
    }
  for (const auto& [name, content] : content_) rename_over(temporary.path() / name, target / name);
}

void write_output_file(const std::string& file, const std::string& content, bool force) {
  const fs::path target = file;
  std::error_code error;
  if (fs::is_directory(target, error))
    throw ConfigError({{file, 0, 0}, "", "a directory", "the name of a file", ""});
  if (!force && fs::exists(target, error)) refuse_existing(target);
  refuse_input(target);
  rename_into_place(target, content);
}

bool remove_output_file(const std::string& file) {
  refuse_input(file);
  std::error_code error;
  if (fs::is_directory(file, error))
    throw ConfigError({{file, 0, 0}, "", "a directory", "the name of a file", ""});
  const bool removed = fs::remove(file, error);
  if (error) fail(file, "remove", error.message());
  return removed;
}

void replace_file(const std::string& file, const std::string& content) {
  std::error_code error;
  const fs::path target = fs::weakly_canonical(file, error);
  if (error) fail(file, "write", error.message());
  struct stat earlier {};
  if (::stat(target.c_str(), &earlier) != 0) return rename_into_place(target, content);
  if (::access(target.c_str(), W_OK) != 0) fail(file, "write", std::strerror(errno));
  rename_into_place(target, content, earlier.st_mode & 07777);
}

}  // namespace joulepath
