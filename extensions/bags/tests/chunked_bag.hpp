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

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// The same bag without its chunks and without an index: every record by itself.
inline std::string unchunked(const std::string& bag) {
  std::string file = bag.substr(0, 8);
  const std::size_t in_chunk =
      8 + 8 + 8 + 4 + 4 + 8;  // before the records: times, sizes, check sum, compression
  for (std::size_t at = 8; bag[at] != '\x0F'; at += 9 + number_at<std::uint64_t>(bag, at + 1)) {
    const std::size_t size = number_at<std::uint64_t>(bag, at + 1);
    if (bag[at] == '\x06') file += bag.substr(at + 9 + in_chunk, size - in_chunk);
    if (bag[at] == '\x01') file += bag.substr(at, 9 + size);
  }
  file += '\x0F';
  put(file, std::uint64_t{4});
  put(file, std::uint32_t{0});
  file += '\x02';
  put(file, std::uint64_t{20});
  file.append(20, '\0');
  return file + bag.substr(0, 8);
}

/// A bag without chunks, with all its records in one.
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
