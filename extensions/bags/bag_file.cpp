#include "extensions/bags/bag_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "extensions/bags/sqlite_bag.hpp"
#include "extensions/bags/unpacked_bytes.hpp"
#include "scenarios/registry.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

bool is_bag_name(const fs::path& file) { return file.extension() == ".db3" || file.extension() == ".mcap"; }
bool is_ros_1_name(const fs::path& file) { return file.extension() == ".bag"; }

/// The bags in a folder; rosbag2 numbers them: name_9.db3 comes before name_10.db3.
std::vector<std::string> bags_in(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (is_bag_name(entry.path())) files.push_back(entry.path().string());
  std::ranges::sort(files, {}, [](const std::string& file) { return std::pair(file.size(), file); });
  return files;
}

bool has_metadata(const std::string& folder) {
  std::error_code ignored;
  return fs::exists(fs::path(folder) / "metadata.yaml", ignored);
}

bool is_folder(const std::string& file) {
  std::error_code ignored;
  return fs::is_directory(file, ignored) && (has_metadata(file) || !bags_in(file).empty());
}

/// The files of a folder, in the order of its metadata, or, without it, of their numbers. A file outside of
/// the folder is refused.
std::vector<std::string> files_of(const std::string& folder, const NamedBy& named_by) {
  if (!has_metadata(folder)) return bags_in(folder);
  const Document metadata = Document::load((fs::path(folder) / "metadata.yaml").string(), named_by);
  std::vector<std::string> files;
  for (const Node& name : metadata.root()["rosbag2_bagfile_information"]["relative_file_paths"].items()) {
    const std::string file = resolve_file(name, {.untrusted = true});
    if (!is_bag(file) || is_folder(file))
      name.fail("a file that ends with .mcap or .db3", "decompress the file: zstd -d " + name.text());
    if (std::ranges::count(files, file) > 0) name.fail("each file once");
    files.push_back(file);
  }
  return files;
}

/// The reader of a format that another extension knows; null for a bag.
const MessageReader* message_reader_of(const std::string& file) {
  const auto& readers = registry().messages;
  const auto found = std::ranges::find_if(readers, [&](const auto& reader) { return reader.reads(file); });
  return found == readers.end() ? nullptr : &*found;
}

auto reader_of(const std::string& file) {
  if (const MessageReader* reader = message_reader_of(file)) return reader->read;
  return fs::path(file).extension() == ".db3" ? &read_sqlite_bag : &read_mcap;
}

constexpr std::string_view kZstdMagic{"\x28\xB5\x2F\xFD", 4};
constexpr std::uint64_t kMostMessageBytes = 64u << 20;

/// rosbag2 can compress each message by itself; neither CDR nor JSON begins as a zstd frame. False if the
/// frame is broken.
bool unpack(std::string_view& data, std::string& unpacked, UnpackedBytes& sum) {
  if (!data.starts_with(kZstdMagic)) return true;
  const std::uint64_t size = ZSTD_getFrameContentSize(data.data(), data.size());
  if (size > kMostMessageBytes) return false;  // unknown and broken sizes are greater
  sum.add(size);
  unpacked.resize(size);
  if (ZSTD_decompress(unpacked.data(), size, data.data(), data.size()) != size) return false;
  data = unpacked;
  return true;
}

std::uint64_t bytes_in(const std::vector<std::string>& files) {
  std::uint64_t bytes = 0;
  for (const std::string& file : files) {
    std::error_code error;
    const auto size = fs::file_size(file, error);
    if (!error) bytes += size;
  }
  return bytes;
}

/// Beside its size in bytes, the most messages of a bag: each has a time of its own, which takes 3 bytes in
/// the best compressed chunk.
constexpr std::uint64_t kAlwaysMessages = 100'000;

}  // namespace

bool is_bag(const std::string& file) {
  return is_bag_name(file) || is_ros_1_name(file) || is_folder(file) || message_reader_of(file);
}

MessageDamage read_bag(const std::string& file, const NamedBy& named_by,
                       const std::function<void(const MessageChannel&)>& on_channel,
                       const std::function<void(const TimedMessage&)>& on_message) {
  if (is_ros_1_name(file))
    throw named_by.error(file, "a bag of ROS 1", "a bag of ROS 2 (.mcap, .db3)",
                         "convert it: rosbags-convert --src " + file + " --dst " +
                             fs::path(file).replace_extension().string());
  std::map<std::pair<std::string, std::string>, std::size_t> topics;
  MessageDamage damage;
  std::string unpacked;
  const std::vector<std::string> parts = is_folder(file) ? files_of(file, named_by) : std::vector{file};
  const std::uint64_t bytes = bytes_in(parts);
  std::uint64_t messages_left = bytes + kAlwaysMessages;
  UnpackedBytes sum(file, named_by, bytes);
  for (const std::string& part : parts) {
    std::vector<std::size_t> channels;
    const auto open = [&](const MessageChannel& channel) {
      const auto [topic, added] = topics.try_emplace({channel.topic, channel.type}, topics.size());
      channels.push_back(topic->second);
      if (added) on_channel(channel);
    };
    const auto take = [&](TimedMessage message) {
      if (messages_left-- == 0)
        throw named_by.error(file, "more messages than " + std::to_string(bytes) + " bytes record",
                             "a bag with a message for a byte at most");
      message.channel = channels[message.channel];
      if (unpack(message.data, unpacked, sum))
        on_message(message);
      else
        ++damage.broken_records;
    };
    const MessageDamage more = reader_of(part)(part, named_by, open, take);
    damage.truncated = damage.truncated || more.truncated;
    damage.unread_bytes += more.unread_bytes;
    damage.broken_chunks += more.broken_chunks;
    damage.broken_records += more.broken_records;
  }
  return damage;
}

}  // namespace joulepath
