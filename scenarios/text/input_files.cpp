#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>
#include <system_error>

#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

constexpr std::string_view kDataDirectory = "${JOULEPATH_DATA_DIR}";

struct Inputs {
  std::mutex mutex{};
  std::set<std::string> files{};
};

Inputs& inputs() {
  static Inputs all;
  return all;
}

std::string one_name(const std::string& file) {
  std::error_code error;
  const std::string name = std::filesystem::weakly_canonical(file, error).string();
  return error ? file : name;
}

/// The text of a node, with ${JOULEPATH_DATA_DIR} at its beginning replaced by the environment variable.
std::string with_data_directory(const Node& node, const ReadOptions& options) {
  const std::string& name = node.text();
  if (options.untrusted || name.compare(0, kDataDirectory.size(), kDataDirectory) != 0) return name;
  const char* folder = std::getenv("JOULEPATH_DATA_DIR");
  if (!folder)
    node.fail("a file; the environment variable JOULEPATH_DATA_DIR is not set",
              "set it to the folder that holds the data");
  return std::string(folder) + name.substr(kDataDirectory.size());
}

}  // namespace

ConfigError NamedBy::error(const std::string& file, std::string found, std::string accepted,
                           std::string hint) const {
  if (mark.file.empty())
    return ConfigError({{file, 0, 0}, "", std::move(found), std::move(accepted), std::move(hint)});
  return ConfigError({mark, key, file + ", " + found, std::move(accepted), std::move(hint)});
}

std::string read_text_file(const std::string& file, const NamedBy& named_by) {
  std::error_code error;
  const auto kind = std::filesystem::status(file, error).type();
  if (kind == std::filesystem::file_type::directory) throw named_by.error(file, "a directory", "a file");
  // A FIFO or a device may have no end, or no writer.
  if (std::filesystem::exists(std::filesystem::file_status(kind)) &&
      kind != std::filesystem::file_type::regular)
    throw named_by.error(file, "a pipe, a socket or a device", "a regular file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream && errno == EACCES) throw std::system_error(errno, std::generic_category(), file);
  if (!stream)
    throw named_by.error(
        file, std::string("no readable file (") + std::strerror(errno) + ")", "a file that can be read",
        named_by.mark.line > 0 ? "relative paths are relative to the file that names them" : "");
  std::string text;
  try {
    text.assign(std::istreambuf_iterator<char>(stream), {});
  } catch (const std::ios_base::failure&) {
    throw named_by.error(file, "a file that cannot be read to its end", "a readable file");
  }
  const std::lock_guard lock(inputs().mutex);
  inputs().files.insert(one_name(file));
  return text;
}

bool is_input(const std::string& file) {
  const std::lock_guard lock(inputs().mutex);
  return inputs().files.contains(one_name(file));
}

void forget_input(const std::string& file) {
  const std::lock_guard lock(inputs().mutex);
  inputs().files.erase(one_name(file));
}

void forget_inputs() {
  const std::lock_guard lock(inputs().mutex);
  inputs().files.clear();
}

std::string resolve_file(const Node& node, const ReadOptions& options) {
  namespace fs = std::filesystem;
  const fs::path name = with_data_directory(node, options);
  if (name.empty()) node.fail_found("an empty text", "the name of a file");
  const fs::path folder = fs::path(node.mark().file).parent_path();
  const fs::path resolved = name.is_absolute() ? name : folder / name;
  if (options.untrusted) {
    const std::string accepted = "a path inside of the input's folder";
    const std::string hint = "the input is read as untrusted";
    if (name.is_absolute()) node.fail(accepted, hint);
    std::error_code error;
    const fs::path base = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
    const fs::path target = fs::weakly_canonical(resolved, error);
    const auto mismatch = std::mismatch(base.begin(), base.end(), target.begin(), target.end());
    if (error || mismatch.first != base.end()) node.fail(accepted, hint);
  }
  return resolved.lexically_normal().string();
}

}  // namespace joulepath
