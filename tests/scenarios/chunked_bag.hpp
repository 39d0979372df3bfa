#pragma once

#include <lz4frame.h>
#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <string>

namespace joulepath::testing {

template <class Number>
void put(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// The same bag with all its records in one chunk.
inline std::string chunked(const std::string& bag, const std::string& compression) {
  const std::string records = bag.substr(8, bag.size() - 8 - 8 - 29 - 13);  // less magics, footer, data end
  std::string packed = records;
  if (compression == "zstd") {
    packed.resize(ZSTD_compressBound(records.size()));
    packed.resize(ZSTD_compress(packed.data(), packed.size(), records.data(), records.size(), 3));
  } else if (compression == "lz4") {
    packed.resize(LZ4F_compressFrameBound(records.size(), nullptr));
    packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), records.data(), records.size(), nullptr));
  }
  std::string content;
  put(content, std::uint64_t{0});
  put(content, std::uint64_t{0});
  put(content, static_cast<std::uint64_t>(records.size()));
  put(content, std::uint32_t{0});
  put(content, static_cast<std::uint32_t>(compression.size()));
  content += compression;
  put(content, static_cast<std::uint64_t>(packed.size()));
  content += packed;
  std::string file = bag.substr(0, 8);
  file += '\x06';
  put(file, static_cast<std::uint64_t>(content.size()));
  return file + content + bag.substr(bag.size() - 8 - 29 - 13);
}

}  // namespace joulepath::testing
