#pragma once

#include <cstddef>
#include <istream>
#include <string>

namespace joulepath {

/// The next line, without its end, as std::getline has it; false where none is left. Of a line of more than
/// `most_bytes` the first most_bytes + 1 are read; the rest stays in the stream.
inline bool next_line(std::istream& in, std::string& line, std::size_t most_bytes) {
  line.clear();
  std::streambuf& bytes = *in.rdbuf();
  while (line.size() <= most_bytes) {
    const int c = bytes.sbumpc();
    if (c == '\n') return true;
    if (c == std::char_traits<char>::eof()) {
      in.setstate(std::ios::eofbit);
      return !line.empty();
    }
    line.push_back(static_cast<char>(c));
  }
  return true;
}

}  // namespace joulepath
