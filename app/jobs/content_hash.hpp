#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace joulepath {

/// FNV-1a over parts; the length of each part is included, so that different lists of parts have different
/// input.
class ContentHash {
 public:
  ContentHash& mix(const std::string& part) {
    for (const char c : part + "/" + std::to_string(part.size()))
      hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    return *this;
  }

  /// 16 hexadecimal digits.
  [[nodiscard]] std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
    return digits;
  }

 private:
  std::uint64_t hash_{1469598103934665603ULL};
};

}  // namespace joulepath
