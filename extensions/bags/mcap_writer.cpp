#include "extensions/bags/mcap_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <utility>

// Format: https://mcap.dev/spec, version 0. Design: docs/decisions/0602-bags.md
namespace joulepath {
namespace {

constexpr std::size_t kChunkBytes = 1u << 20;

template <class Number>
void put(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// A length of 32 bits, then that many bytes.
void put_sized(std::string& bytes, std::string_view content) {
  put(bytes, static_cast<std::uint32_t>(content.size()));
  bytes.append(content);
}

void put_record(std::string& bytes, McapRecord kind, std::string_view content) {
  put(bytes, kind);
  put(bytes, static_cast<std::uint64_t>(content.size()));
  bytes.append(content);
}

std::uint32_t check_sum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace

void McapWriter::Times::add(std::uint64_t time_ns) {
  first_ns = std::min(first_ns, time_ns);
  last_ns = std::max(last_ns, time_ns);
}

/// Both are 0 without messages.
void McapWriter::Times::put(std::string& bytes) const {
  joulepath::put(bytes, std::min(first_ns, last_ns));
  joulepath::put(bytes, last_ns);
}

McapWriter::McapWriter() : bytes_(kMcapMagic) {
  std::string header;
  put_sized(header, "ros2");
  put_sized(header, "joulepath");
  put_record(bytes_, McapRecord::header, header);
}

std::uint16_t McapWriter::channel(const MessageChannel& channel) {
  const std::uint16_t id = ++channels_;
  std::string content, schema, record;
  put(content, id);
  put_sized(content, channel.type);
  put_sized(content, channel.schema_encoding);
  put_sized(content, channel.schema);
  put_record(schema, McapRecord::schema, content);
  content.clear();
  put(content, id);
  put(content, id);
  put_sized(content, channel.topic);
  put_sized(content, channel.encoding);
  put(content, std::uint32_t{0});  // no metadata
  put_record(record, McapRecord::channel, content);
  chunk_ += schema + record;
  schemas_ += schema;
  channel_records_ += record;
  return id;
}

void McapWriter::message(std::uint16_t channel, std::uint64_t time_ns, std::string_view data) {
  std::string& places = chunk_messages_[channel];
  put(places, time_ns);
  put(places, static_cast<std::uint64_t>(chunk_.size()));
  std::string content;
  put(content, channel);
  put(content, messages_++);
  put(content, time_ns);
  put(content, time_ns);
  content.append(data);
  put_record(chunk_, McapRecord::message, content);
  ++messages_of_channel_[channel];
  times_.add(time_ns);
  chunk_times_.add(time_ns);
  if (chunk_.size() >= kChunkBytes) close_chunk();
}

/// Writes the open chunk, the places of its messages behind it, and its entry of the summary.
void McapWriter::close_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t start = bytes_.size();
  std::string content, offsets;
  chunk_times_.put(content);
  put(content, static_cast<std::uint64_t>(chunk_.size()));
  put(content, check_sum(chunk_));
  put_sized(content, "");  // not compressed
  put(content, static_cast<std::uint64_t>(chunk_.size()));
  put_record(bytes_, McapRecord::chunk, content + chunk_);
  const std::uint64_t index_start = bytes_.size();
  for (const auto& [channel, places] : chunk_messages_) {
    put(offsets, channel);
    put(offsets, static_cast<std::uint64_t>(bytes_.size()));
    content.clear();
    put(content, channel);
    put_sized(content, places);
    put_record(bytes_, McapRecord::message_index, content);
  }
  add_chunk_index(start, index_start, offsets);
  ++chunks_;
  chunk_.clear();
  chunk_times_ = {};
  chunk_messages_.clear();
}

void McapWriter::add_chunk_index(std::uint64_t start, std::uint64_t index_start, const std::string& offsets) {
  std::string content;
  chunk_times_.put(content);
  put(content, start);
  put(content, index_start - start);
  put_sized(content, offsets);
  put(content, bytes_.size() - index_start);
  put_sized(content, "");
  put(content, static_cast<std::uint64_t>(chunk_.size()));  // compressed
  put(content, static_cast<std::uint64_t>(chunk_.size()));
  put_record(chunk_index_, McapRecord::chunk_index, content);
}

std::string McapWriter::statistics() const {
  std::string content, counts, record;
  for (const auto& [channel, count] : messages_of_channel_) {
    put(counts, channel);
    put(counts, count);
  }
  put(content, std::uint64_t{messages_});
  put(content, channels_);  // schemas: one of each channel
  put(content, std::uint32_t{channels_});
  put(content, std::uint32_t{0});  // attachments
  put(content, std::uint32_t{0});  // metadata
  put(content, chunks_);
  times_.put(content);
  put_sized(content, counts);
  put_record(record, McapRecord::statistics, content);
  return record;
}

/// The summary, the offsets of its groups and the footer, whose check sum covers all three.
void McapWriter::put_summary() {
  const std::uint64_t start = bytes_.size();
  std::string offsets;
  for (const auto& [kind, records] : {std::pair{McapRecord::schema, schemas_},
                                      {McapRecord::channel, channel_records_},
                                      {McapRecord::statistics, statistics()},
                                      {McapRecord::chunk_index, chunk_index_}}) {
    if (records.empty()) continue;
    std::string content;
    put(content, kind);
    put(content, static_cast<std::uint64_t>(bytes_.size()));
    put(content, static_cast<std::uint64_t>(records.size()));
    put_record(offsets, McapRecord::summary_offset, content);
    bytes_ += records;
  }
  const std::uint64_t offsets_start = bytes_.size();
  bytes_ += offsets;
  put(bytes_, McapRecord::footer);
  put(bytes_, std::uint64_t{8 + 8 + 4});
  put(bytes_, start);
  put(bytes_, offsets_start);
  put(bytes_, check_sum(std::string_view(bytes_).substr(start)));
}

std::string McapWriter::finish() {
  close_chunk();
  std::string no_check_sum;
  put(no_check_sum, std::uint32_t{0});
  put_record(bytes_, McapRecord::data_end, no_check_sum);
  put_summary();
  bytes_.append(kMcapMagic);
  return std::move(bytes_);
}

}  // namespace joulepath
