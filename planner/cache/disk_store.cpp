#include "planner/cache/disk_store.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "planner/cache/bytes.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "joulepath answer 1\n";
constexpr std::uint64_t kScansPerLimit =
    16;                             ///< written bytes after which the size of the folder is computed again
constexpr double kKeptShare = 0.9;  ///< of the limit, after a deletion
constexpr std::chrono::hours kAbandoned{1};  ///< an older temporary file has no writer any more

std::string checksum_of(const ContentKey& key, const std::string& answer) {
  return content_key(key.text() + answer).text();
}

/// The name of a temporary file that no other thread or process uses.
std::string beside(const std::string& file) {
  static std::atomic<unsigned> count{0};
  return file + "." + std::to_string(::getpid()) + "." + std::to_string(count++) + ".new";
}

struct KeptFile {
  fs::path path{};
  fs::file_time_type used{};
  std::uint64_t bytes{};
};

/// True for files that a store wrote: `FF/` and 30 hexadecimal digits, a draft with `.PID.NUMBER.new` behind.
bool is_own_file(const fs::path& file) {
  const auto is_hex = [](const std::string& text, std::size_t size) {
    return text.size() == size && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  };
  const std::string name = file.filename().string();
  return is_hex(file.parent_path().filename().string(), 2) && is_hex(name.substr(0, 30), 30) &&
         (name.size() == 30 || (name[30] == '.' && file.extension() == ".new"));
}

/// Every file of the store in the folder, without those that other processes delete meanwhile. The user may
/// have named a folder with other files: they are none of the store's.
std::vector<KeptFile> files_in(const std::string& folder) {
  std::vector<KeptFile> files;
  std::error_code error;
  const auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, options, error), end; !error && at != end;
       at.increment(error)) {
    if (at.depth() > 0) at.disable_recursion_pending();
    std::error_code gone;
    if (at.depth() != 1 || !is_own_file(at->path()) || !at->is_regular_file(gone) || gone) continue;
    KeptFile file{at->path(), at->last_write_time(gone), 0};
    if (!gone) file.bytes = at->file_size(gone);
    if (!gone) files.push_back(std::move(file));
  }
  return files;
}

}  // namespace

std::string DiskStore::file_of(const ContentKey& key) const {
  const std::string name = key.text();
  return folder_ + "/" + name.substr(0, 2) + "/" + name.substr(2);
}

std::optional<std::string> DiskStore::find(const ContentKey& key) const {
  const std::string file = file_of(key);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::ostringstream content;
  content << stream.rdbuf();
  const std::string text = std::move(content).str();
  std::string magic, checksum, answer;
  ByteReader reader(text);
  reader(magic, checksum, answer);
  if (!reader.finished() || magic != kMagic || checksum != checksum_of(key, answer)) return std::nullopt;
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
  return answer;
}

void DiskStore::keep(const ContentKey& key, const std::string& answer) {
  const std::string file = file_of(key), draft = beside(file);
  ByteWriter writer;
  writer(kMagic, checksum_of(key, answer), answer);
  std::error_code error;
  fs::create_directories(fs::path(file).parent_path(), error);
  bool whole = false;
  {
    std::ofstream stream(draft, std::ios::binary);
    stream.write(writer.bytes().data(), static_cast<std::streamsize>(writer.bytes().size()));
    whole = static_cast<bool>(stream.flush());
  }
  if (whole) fs::rename(draft, file, error);
  if (!whole || error) fs::remove(draft, error);
  const std::lock_guard lock(mutex_);
  written_bytes_ += writer.bytes().size();
  if (scanned_ && written_bytes_ < limit_bytes_ / kScansPerLimit) return;
  delete_oldest();
  scanned_ = true;
  written_bytes_ = 0;
}

void DiskStore::delete_oldest() {
  std::vector<KeptFile> files = files_in(folder_);
  std::sort(files.begin(), files.end(), [](const KeptFile& a, const KeptFile& b) { return a.used < b.used; });
  std::uint64_t sum_bytes = 0;
  for (const KeptFile& file : files) sum_bytes += file.bytes;
  const auto goal_bytes = static_cast<std::uint64_t>(kKeptShare * static_cast<double>(limit_bytes_));
  const bool full = sum_bytes > limit_bytes_;
  const auto now = fs::file_time_type::clock::now();
  for (const KeptFile& file : files) {
    const bool draft = file.path.extension() == ".new", abandoned = draft && now - file.used > kAbandoned;
    if (!abandoned && (draft || !full || sum_bytes <= goal_bytes)) continue;
    std::error_code gone;
    fs::remove(file.path, gone);
    sum_bytes -= file.bytes;
  }
}

}  // namespace joulepath
