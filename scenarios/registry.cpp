#include "scenarios/registry.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenarios/text/next_line.hpp"

namespace joulepath {
namespace {

namespace fs = std::filesystem;

/// Whether all words, separated by blanks, fit.
template <class Fits>
bool all_words(std::string_view words, const Fits& fits) {
  std::istringstream stream{std::string(words)};
  for (std::string word; stream >> word;)
    if (!fits(word)) return false;
  return true;
}

/// The first line of a file of JSON lines; empty for other files.
std::string first_json_line(const std::string& file) {
  constexpr std::size_t kMostBytes = 1u << 20;
  const fs::path extension = fs::path(file).extension();
  std::string line;
  if (extension != ".jsonl" && extension != ".ndjson") return line;
  std::ifstream in(file, std::ios::binary);
  next_line(in, line, kMostBytes);
  return line;
}

bool is_recognized(const Addition& addition, const std::string& file) {
  if (addition.part == "file") return fs::path(file).extension() == addition.name;
  std::error_code ignored;
  if (addition.part == "folder")
    return fs::is_directory(file, ignored) && fs::exists(fs::path(file) / addition.name, ignored);
  if (addition.part == "lines") {
    const std::string first_line = first_json_line(file);
    return !first_line.empty() && all_words(addition.name, [&](const std::string& key) {
      return first_line.find('"' + key + '"') != std::string::npos;
    });
  }
  return addition.part == "messages" &&
         std::any_of(registry().messages.begin(), registry().messages.end(),
                     [&](const MessageReader& reader) { return reader.reads(file); });
}

}  // namespace

const Registry& registry() {
  static const Registry all = [] {
    Registry made;
    add_extensions(made);
    return made;
  }();
  return all;
}

std::string_view absent_extension(std::string_view part, std::string_view name) {
  for (const Addition& addition : known_additions())
    if (!addition.is_built && addition.part == part && addition.name == name) return addition.extension;
  return {};
}

std::string accepted_extension(std::string_view extension) {
  return "a program with the extension " + std::string(extension);
}

std::string extension_hint(std::string_view extension) {
  return "this program was built without " + std::string(extension) +
         "; in a clone, ./dev build builds all extensions";
}

void refuse_absent_word(std::string_view part, const std::string& word, const Node& place) {
  if (const std::string_view extension = absent_extension(part, word); !extension.empty())
    place.fail_found(std::string(part) + " " + word, accepted_extension(extension),
                     extension_hint(extension));
}

void refuse_absent_file(const std::string& file, const NamedBy& named_by) {
  for (const Addition& addition : known_additions())
    if (!addition.is_built && is_recognized(addition, file))
      throw named_by.error(file, "a file of the extension " + std::string(addition.extension),
                           accepted_extension(addition.extension), extension_hint(addition.extension));
}

void refuse_absent_document(const Document& document) {
  const Node root = document.root();
  if (root.kind() != Value::Kind::map) return;
  for (const Addition& addition : known_additions())
    if (!addition.is_built && addition.part == "document" &&
        all_words(addition.name, [&](const std::string& key) { return root.has(key); }))
      root.fail_found("keys of another format: " + std::string(addition.name),
                      accepted_extension(addition.extension), extension_hint(addition.extension));
}

}  // namespace joulepath
