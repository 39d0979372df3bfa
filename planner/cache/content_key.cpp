#include "planner/cache/content_key.hpp"

#include <cstdio>
#include <cstring>

namespace joulepath {
namespace {

/// Spreads every bit over all others (the finalizer of MurmurHash3, a public-domain constant pair).
std::uint64_t spread(std::uint64_t x) {
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdULL;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return x ^ (x >> 33);
}

}  // namespace

ContentKey content_key(std::string_view bytes) {
  ContentKey key{0x9e3779b97f4a7c15ULL, bytes.size()};
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t count = bytes.size() < sizeof word ? bytes.size() : sizeof word;
    std::memcpy(&word, bytes.data(), count);
    bytes.remove_prefix(count);
    key.first = spread(key.first ^ word);
    key.second = spread(key.second + word) + key.first;
  }
  return {spread(key.first + key.second), spread(key.second ^ (key.first << 1))};
}

std::string ContentKey::text() const {
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(first),
                static_cast<unsigned long long>(second));
  return digits;
}

}  // namespace joulepath
