#pragma once

#include <cstdint>
#include <string>

#include "scenarios/text/document.hpp"

namespace joulepath {

/// Bounds what a bag unpacks to, in all its chunks and messages together: a small file may hold many chunks
/// of a few kilobytes that unpack to hundreds of megabytes each. Recorded messages unpack to at most about
/// 100 times their size, even those of a robot at rest, whose times alone differ.
class UnpackedBytes {
 public:
  UnpackedBytes(std::string file, NamedBy named_by, std::uint64_t packed_bytes)
      : file_(std::move(file)), named_by_(std::move(named_by)), left_(kAlways + kRatio * packed_bytes) {}

  /// Throws ConfigError beyond the bound; called before memory is taken.
  void add(std::uint64_t bytes) {
    if (bytes > left_)
      throw named_by_.error(file_, "data that unpack to more than 1000 times their size", "a recorded bag");
    left_ -= bytes;
  }

 private:
  static constexpr std::uint64_t kAlways = 256u << 20, kRatio = 1000;

  std::string file_;
  NamedBy named_by_;
  std::uint64_t left_;
};

}  // namespace joulepath
