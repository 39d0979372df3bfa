#include "scenarios/bags/bag_file.hpp"

#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "scenarios/bags/sqlite_bag.hpp"
#include "scenarios/bags/state_lines.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& file) {
  std::error_code ignored;
  return fs::is_directory(file, ignored) && fs::exists(fs::path(file) / "metadata.yaml", ignored);
}

/// The files of a folder, in the order of its metadata. A file outside of the folder is refused.
std::vector<std::string> files_of(const std::string& folder, const NamedBy& named_by) {
  const Document metadata = Document::load((fs::path(folder) / "metadata.yaml").string(), named_by);
  std::vector<std::string> files;
  for (const Node& name : metadata.root()["rosbag2_bagfile_information"]["relative_file_paths"].items()) {
    const std::string file = resolve_file(name, {.untrusted = true});
    if (!is_bag(file) || is_folder(file))
      name.fail("a file that ends with .mcap or .db3", "decompress the file: zstd -d " + name.text());
    files.push_back(file);
  }
  return files;
}

auto reader_of(const std::string& file) {
  if (is_state_lines(file)) return &read_state_lines;
  return fs::path(file).extension() == ".db3" ? &read_sqlite_bag : &read_mcap;
}

}  // namespace

bool is_bag(const std::string& file) {
  const fs::path extension = fs::path(file).extension();
  return extension == ".mcap" || extension == ".db3" || is_folder(file) || is_state_lines(file);
}

BagDamage read_bag(const std::string& file, const NamedBy& named_by,
                   const std::function<void(const BagChannel&)>& on_channel,
                   const std::function<void(const BagMessage&)>& on_message) {
  std::map<std::pair<std::string, std::string>, std::size_t> topics;
  BagDamage damage;
  for (const std::string& part : is_folder(file) ? files_of(file, named_by) : std::vector{file}) {
    std::vector<std::size_t> channels;
    const auto open = [&](const BagChannel& channel) {
      const auto [topic, added] = topics.try_emplace({channel.topic, channel.type}, topics.size());
      channels.push_back(topic->second);
      if (added) on_channel(channel);
    };
    const auto take = [&](BagMessage message) {
      message.channel = channels[message.channel];
      on_message(message);
    };
    const BagDamage more = reader_of(part)(part, named_by, open, take);
    damage.truncated = damage.truncated || more.truncated;
    damage.broken_chunks += more.broken_chunks;
    damage.broken_records += more.broken_records;
  }
  return damage;
}

}  // namespace joulepath
