#include "scenarios/bags/mcap_writer.hpp"

namespace joulepath {
namespace {

template <class Number>
void put(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

void put_text(std::string& bytes, std::string_view text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes.append(text);
}

}  // namespace

McapWriter::McapWriter() : bytes_(kMcapMagic) {
  std::string header;
  put_text(header, "ros2");
  put_text(header, "joulepath");
  record(0x01, header);
}

std::uint16_t McapWriter::channel(const BagChannel& channel) {
  const std::uint16_t id = ++channels_;
  std::string schema, record_of;
  put(schema, id);
  put_text(schema, channel.type);
  put_text(schema, channel.schema_encoding);
  put_text(schema, channel.schema);
  record(0x03, schema);
  put(record_of, id);
  put(record_of, id);
  put_text(record_of, channel.topic);
  put_text(record_of, channel.encoding);
  put(record_of, std::uint32_t{0});  // no metadata
  record(0x04, record_of);
  return id;
}

void McapWriter::message(std::uint16_t channel, std::uint64_t time_ns, std::string_view data) {
  std::string content;
  put(content, channel);
  put(content, messages_++);
  put(content, time_ns);
  put(content, time_ns);
  content.append(data);
  record(0x05, content);
}

std::string McapWriter::finish() {
  std::string check_sum, footer;
  put(check_sum, std::uint32_t{0});
  record(0x0F, check_sum);
  put(footer, std::uint64_t{0});
  put(footer, std::uint64_t{0});
  put(footer, std::uint32_t{0});
  record(0x02, footer);
  bytes_.append(kMcapMagic);
  return std::move(bytes_);
}

void McapWriter::record(std::uint8_t opcode, std::string_view content) {
  put(bytes_, opcode);
  put(bytes_, static_cast<std::uint64_t>(content.size()));
  bytes_.append(content);
}

}  // namespace joulepath
