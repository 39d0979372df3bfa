#include "extensions/bags/mcap_file.hpp"

#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <fstream>
#include <map>
#include <memory>
#include <unordered_map>

#include "extensions/bags/byte_cursor.hpp"
#include "extensions/bags/unpacked_bytes.hpp"

// Format: https://mcap.dev/spec, version 0
namespace joulepath {
namespace {

constexpr std::uint64_t kMostChunkBytes = 256u << 20;
constexpr std::uint64_t kMostRecordBytes = 256u << 20;
constexpr std::size_t kMostChannels = 65536;

void decompress_lz4(std::string_view from, std::string& to) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  std::size_t done = 0;
  while (done < to.size() && !from.empty()) {
    std::size_t written = to.size() - done, read = from.size();
    const std::size_t hint =
        LZ4F_decompress(context.get(), to.data() + done, &written, from.data(), &read, nullptr);
    if (LZ4F_isError(hint) || (written == 0 && read == 0)) throw BytesEnd();
    done += written;
    from.remove_prefix(read);
  }
  if (done != to.size()) throw BytesEnd();
}

void decompress_zstd(std::string_view from, std::string& to) {
  if (ZSTD_decompress(to.data(), to.size(), from.data(), from.size()) != to.size()) throw BytesEnd();
}

class McapReader {
 public:
  McapReader(const std::string& file, const NamedBy& named_by,
             const std::function<void(const MessageChannel&)>& on_channel,
             const std::function<void(const TimedMessage&)>& on_message)
      : in_(file, std::ios::binary), on_channel_(on_channel), on_message_(on_message) {
    if (!in_) throw named_by.error(file, "no readable file", "a bag in the MCAP format");
    in_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(in_.tellg(), 0));
    unpacked_.emplace(file, named_by, size_);
    in_.seekg(0);
    std::string magic(kMcapMagic.size(), '\0');
    if (!in_.read(magic.data(), static_cast<std::streamsize>(magic.size())) || magic != kMcapMagic)
      throw named_by.error(file, "no MCAP file", "a bag in the MCAP format");
  }

  MessageDamage read() {
    std::uint64_t at = kMcapMagic.size(), begin = at;
    std::string content;
    for (;; begin = at) {
      std::uint8_t head[9];
      if (!in_.read(reinterpret_cast<char*>(head), sizeof head)) break;
      std::uint64_t length{};
      std::memcpy(&length, head + 1, sizeof length);
      at += sizeof head;
      const McapRecord kind{head[0]};
      if (kind == McapRecord::data_end) return damage_;
      if (length > size_ - at) break;
      at += length;
      if (!wanted(kind) || length > kMostRecordBytes) {
        if (wanted(kind)) ++damage_.broken_records;
        in_.seekg(static_cast<std::streamoff>(at));
        continue;
      }
      content.resize(length);
      if (!in_.read(content.data(), static_cast<std::streamsize>(length))) break;
      record(kind, content);
    }
    damage_.truncated = true;
    damage_.unread_bytes = size_ - begin;
    return damage_;
  }

 private:
  static bool wanted(McapRecord kind) {
    return kind == McapRecord::schema || kind == McapRecord::channel || kind == McapRecord::message ||
           kind == McapRecord::chunk;
  }

  void record(McapRecord kind, std::string_view content) {
    try {
      ByteCursor in(content);
      if (kind == McapRecord::schema) schema(in);
      if (kind == McapRecord::channel) channel(in);
      if (kind == McapRecord::message) message(in);
      if (kind == McapRecord::chunk) chunk(in);
    } catch (const BytesEnd&) {
      ++(kind == McapRecord::chunk ? damage_.broken_chunks : damage_.broken_records);
    }
  }

  void schema(ByteCursor& in) {
    const auto id = in.number<std::uint16_t>();
    MessageChannel described;
    described.type = in.text();
    described.schema_encoding = in.text();
    described.schema = in.text();
    schemas_[id] = std::move(described);
  }

  void channel(ByteCursor& in) {
    const auto id = in.number<std::uint16_t>();
    const auto schema_id = in.number<std::uint16_t>();
    const auto described = schemas_.find(schema_id);
    MessageChannel channel = described == schemas_.end() ? MessageChannel{} : described->second;
    channel.topic = in.text();
    channel.encoding = in.text();
    if (channels_.contains(id) || channels_.size() >= kMostChannels) return;
    channels_[id] = channels_.size();
    on_channel_(channel);
  }

  void message(ByteCursor& in) {
    const auto known = channels_.find(in.number<std::uint16_t>());
    in.number<std::uint32_t>();  // sequence
    TimedMessage message{.log_time_ns = in.number<std::uint64_t>()};
    in.number<std::uint64_t>();  // publish time
    if (known == channels_.end()) throw BytesEnd();
    message.channel = known->second;
    message.data = in.take(in.left());
    on_message_(message);
  }

  void chunk(ByteCursor& in) {
    in.take(16);  // first and last time
    const auto size = in.number<std::uint64_t>();
    const auto check_sum = in.number<std::uint32_t>();
    const std::string_view compression = in.text();
    const std::string_view records = in.take(in.number<std::uint64_t>());
    if (compression.empty()) {
      chunk_records(records, check_sum);
      return;
    }
    if (size > kMostChunkBytes) throw BytesEnd();
    unpacked_->add(size);
    chunk_.resize(size);
    if (compression == "lz4")
      decompress_lz4(records, chunk_);
    else if (compression == "zstd")
      decompress_zstd(records, chunk_);
    else
      throw BytesEnd();
    chunk_records(chunk_, check_sum);
  }

  void chunk_records(std::string_view records, std::uint32_t check_sum) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(records.data());
    if (check_sum != 0 && crc32_z(0, bytes, records.size()) != check_sum) throw BytesEnd();
    ByteCursor in(records);
    while (in.left() > 0) {
      const McapRecord kind{in.number<std::uint8_t>()};
      const std::string_view content = in.take(in.number<std::uint64_t>());
      if (kind != McapRecord::chunk) record(kind, content);
    }
  }

  std::ifstream in_;
  std::uint64_t size_{};
  std::optional<UnpackedBytes> unpacked_{};
  const std::function<void(const MessageChannel&)>& on_channel_;
  const std::function<void(const TimedMessage&)>& on_message_;
  std::map<std::uint16_t, MessageChannel> schemas_{};
  std::unordered_map<std::uint16_t, std::size_t> channels_{};
  std::string chunk_{};
  MessageDamage damage_{};
};

}  // namespace

std::string truncation_text(const MessageDamage& damage) {
  const std::string text = "the bag is truncated";
  return damage.unread_bytes == 0
             ? text
             : text + ": its last " + std::to_string(damage.unread_bytes) + " bytes were not read";
}

std::string no_message_text(const MessageDamage& damage) {
  return "no message" + (damage.truncated ? ": " + truncation_text(damage) : "");
}

MessageDamage read_mcap(const std::string& file, const NamedBy& named_by,
                        const std::function<void(const MessageChannel&)>& on_channel,
                        const std::function<void(const TimedMessage&)>& on_message) {
  return McapReader(file, named_by, on_channel, on_message).read();
}

}  // namespace joulepath
