#include <algorithm>
#include <filesystem>

#include "model/printable.hpp"
#include "scenarios/text/value_builder.hpp"

namespace joulepath {
namespace {

// A scanned YAML token takes about 120 bytes of memory, so that a whole file of one flow list stays below
// 1 GiB; a plan of a long mission in JSON has some ten megabytes.
constexpr std::size_t kMostYamlBytes = std::size_t{8} << 20;
constexpr std::size_t kMostJsonBytes = std::size_t{128} << 20;

bool is_json_name(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  for (const char* json : {".json", ".geojson", ".jsonl", ".ndjson"})
    if (extension == json) return true;
  return false;
}

void refuse_larger(std::size_t bytes, std::size_t most, const std::string& file, const NamedBy& named_by) {
  if (bytes > most)
    throw named_by.error(file, std::to_string(bytes) + " bytes",
                         "at most " + std::to_string(most) + " bytes in a file of this format");
}

/// Throws at the first byte that is not valid UTF-8.
void check_characters(const std::string& text, const std::string& file, int first_line) {
  if (text.find('\0') != std::string::npos)
    throw ConfigError({{file, 0, 0}, "", "binary data", "a text file in YAML or JSON", ""});
  const auto bad = first_byte_not_utf8(text);
  if (!bad) return;
  const auto before = text.begin() + static_cast<std::ptrdiff_t>(*bad);
  const auto line_end = text.rfind('\n', *bad);
  const std::size_t line_begin = line_end == std::string::npos ? 0 : line_end + 1;
  throw ConfigError({{file, first_line + static_cast<int>(std::count(text.begin(), before, '\n')),
                      static_cast<int>(*bad - line_begin) + 1},
                     "",
                     "the byte " + printable(std::string_view(text).substr(*bad, 1)),
                     "text in UTF-8",
                     "the file may be stored in another encoding, Latin-1 for example"});
}

}  // namespace

Document Document::parse(std::string_view text, std::string file, int first_line) {
  Document document;
  document.file_ = std::make_unique<const std::string>(std::move(file));
  const std::string copy(text.substr(text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0));
  const bool json = is_json_name(document.file());
  refuse_larger(copy.size(), json ? kMostJsonBytes : kMostYamlBytes, document.file(), {});
  check_characters(copy, document.file(), first_line);
  document.style_ = json ? PathStyle::pointer : PathStyle::dotted;
  document.root_ = std::make_unique<const Value>(json ? read_json_text(copy, document.file(), first_line)
                                                      : read_yaml_text(copy, document.file(), first_line));
  return document;
}

Document Document::load(const std::string& file, const NamedBy& named_by) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (!error) refuse_larger(bytes, is_json_name(file) ? kMostJsonBytes : kMostYamlBytes, file, named_by);
  return parse(read_text_file(file, named_by), file);
}

}  // namespace joulepath
