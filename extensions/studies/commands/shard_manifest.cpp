#include "extensions/studies/commands/shard_manifest.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/build_id.hpp"
#include "app/command.hpp"
#include "app/jobs/job_results.hpp"
#include "extensions/studies/study_file.hpp"
#include "model/printable.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/document_kind.hpp"

namespace joulepath {
namespace {

/// A text of a file has no line breaks: a study is a list of its lines.
std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    if (line.ends_with('\r')) line.pop_back();
    lines.push_back(printable(line));
  }
  return lines;
}

std::string study_of(const Node& root) {
  std::vector<std::string> lines;
  if (const auto study = root.find("study_text"))
    for (const Node& line : study->items()) lines.push_back(line.text());
  return joined(lines);
}

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostShards = 1'000'000;

std::string file_of(const std::string& directory) { return directory + "/shard.json"; }

[[noreturn]] void refuse(const std::string& directory, const std::string& key, std::string found,
                         std::string accepted, std::string hint = {}) {
  throw ConfigError(
      {{file_of(directory), 0, 0}, key, std::move(found), std::move(accepted), std::move(hint)});
}

/// A value that must be the same in all shards.
struct CommonValue {
  std::string key{};    ///< of shard.json, or an option
  std::string value{};  ///< compared
  std::string said{};   ///< for messages instead of a digest or a long text
};

/// The first ones explain most: a study with other levels has another number of jobs, too.
std::vector<CommonValue> common_values(const ShardManifest& manifest) {
  std::vector<CommonValue> values{
      {"command", manifest.command}, {"version", manifest.version}, {"build", manifest.build}};
  for (const auto& [option, value] : manifest.options) values.push_back({option, value});
  values.insert(values.end(), {{"of", std::to_string(manifest.shard.of)},
                               {"study_text", joined(lines_in(manifest.study_text)), "another study"},
                               {"jobs", std::to_string(manifest.jobs)},
                               {"list", manifest.list_digest, "other missions or designs"}});
  return values;
}

/// Throws ConfigError where two shards are of different runs.
void check_common_values(const std::string& first_directory, const std::vector<CommonValue>& wanted,
                         const std::string& directory, const std::vector<CommonValue>& found) {
  for (std::size_t k = 0; k < std::min(wanted.size(), found.size()); ++k) {
    const auto& [key, value, said] = found[k];
    if (key == wanted[k].key && value == wanted[k].value) continue;
    const std::string there = file_of(first_directory);
    refuse(directory, key, said.empty() ? value : said,
           said.empty() ? wanted[k].value + ", as in " + there : "the same as in " + there,
           "shards of one run have the same inputs, options and program");
  }
}

}  // namespace

Shard shard_from(const std::string& text) {
  if (text.empty()) return {};
  const auto slash = text.find('/');
  const auto number = parse_number(text.substr(0, slash));
  const auto of = slash == std::string::npos ? std::nullopt : parse_number(text.substr(slash + 1));
  const auto is_count = [](double value) { return value == static_cast<double>(static_cast<long>(value)); };
  if (!number || !of || *number < 1 || *of < *number || *of > static_cast<double>(kMostShards) ||
      !is_count(*number) || !is_count(*of))
    throw UsageError("--shard: found " + text + ", accepted: K/N with 1 <= K <= N, 2/8 for example");
  return {static_cast<std::size_t>(*number), static_cast<std::size_t>(*of), true};
}

std::string manifest_text(const ShardManifest& manifest) {
  Json json{{"schema", "joulepath/shard/1"},  {"command", manifest.command},
            {"version", manifest.version},    {"build", manifest.build},
            {"shard", manifest.shard.number}, {"of", manifest.shard.of},
            {"jobs", manifest.jobs},          {"title", manifest.title},
            {"options", manifest.options},    {"list", manifest.list_digest},
            {"files", manifest.files},        {"results", manifest.results_digest}};
  if (!manifest.study_file.empty()) {
    json["study_file"] = manifest.study_file;
    json["study_text"] = lines_in(manifest.study_text);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

ShardManifest read_manifest(const std::string& directory) {
  const Document document = Document::load(file_of(directory));
  check_document(document, "shard", shard_schema());
  const Node root = document.root();
  ShardManifest manifest{
      .command = root["command"].text(),
      .version = root["version"].text(),
      .build = root["build"].text(),
      .shard = {static_cast<std::size_t>(root["shard"].integer()),
                static_cast<std::size_t>(root["of"].integer()), true},
      .jobs = static_cast<std::size_t>(root["jobs"].integer()),
      .title = root["title"].text(),
      .list_digest = root["list"].text(),
      .results_digest = root["results"].text(),
      .study_file = root.text_or("study_file", ""),
      .study_text = study_of(root),
  };
  if (manifest.shard.number > manifest.shard.of) root["shard"].fail("at most the number in `of`");
  for (const auto& [option, value] : root["options"].entries()) manifest.options[option] = value.text();
  for (const auto& [file, digest] : root["files"].entries()) manifest.files[file] = digest.text();
  return manifest;
}

bool has_manifest(const std::string& directory) {
  std::error_code absent;
  return std::filesystem::exists(file_of(directory), absent);
}

void check_complete(const std::vector<std::string>& directories, const std::vector<ShardManifest>& shards) {
  const auto wanted = common_values(shards.front());
  std::map<std::size_t, std::string> directory_of;
  std::map<std::string, std::pair<std::string, std::string>> digest_of;  // file -> digest, directory
  for (std::size_t i = 0; i < shards.size(); ++i) {
    check_common_values(directories[0], wanted, directories[i], common_values(shards[i]));
    const auto [other, is_new] = directory_of.emplace(shards[i].shard.number, directories[i]);
    if (!is_new)
      refuse(directories[i], "shard", shards[i].shard.text() + ", which " + other->second + " holds, too",
             "each shard once");
    for (const auto& [file, digest] : shards[i].files) {
      const auto [known, first] = digest_of.emplace(file, std::pair(digest, directories[i]));
      if (!first && known->second.first != digest)
        refuse(directories[i], "files", file + " with another content than in " + known->second.second,
               "shards that read the same files", "run the older shard again");
    }
  }
  std::string missing;
  std::size_t count = 0;
  for (std::size_t k = 1; k <= shards.front().shard.of; ++k)
    if (!directory_of.contains(k) && ++count <= 10) append_item(missing, std::to_string(k));
  if (count > 0)
    refuse(directories[0], "of",
           std::to_string(count) + " of " + std::to_string(shards.front().shard.of) +
               " shards missing: " + missing + (count > 10 ? ", ..." : ""),
           "the directories of all shards");
  if (shards.front().build != kBuildId)
    refuse(directories[0], "build", shards.front().version + ", build " + shards.front().build,
           JOULEPATH_VERSION ", build " + std::string(kBuildId) + ", which this program is",
           "merge with the program that planned; joulepath --version tells its build");
}

}  // namespace joulepath
