#include "extensions/vda5050/state_lines.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "scenarios/text/next_line.hpp"
#include "scenarios/text/shallow_json.hpp"
#include "scenarios/text/utc_time.hpp"

namespace joulepath {
namespace {

using nlohmann::json;

constexpr std::size_t kMostLineBytes = 16u << 20;
constexpr std::size_t kMostRobots = 4096;

/// The next line. Of a longer one than kMostLineBytes, which is no state, the rest is left out.
bool next_state_line(std::istream& in, std::string& line) {
  const bool found = next_line(in, line, kMostLineBytes);
  if (line.size() > kMostLineBytes) in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  return found;
}

/// The state in a line; discarded where the line is none.
json state_in(const std::string& line) {
  return line.size() > kMostLineBytes ? json(json::value_t::discarded) : shallow_json(line);
}

std::string text_at(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

bool is_state_lines(const std::string& file) {
  const auto extension = std::filesystem::path(file).extension();
  if (extension != ".jsonl" && extension != ".ndjson") return false;
  std::ifstream in(file, std::ios::binary);
  std::string line;
  if (!in || !next_state_line(in, line)) return false;
  const json first = state_in(line);
  return first.is_object() && first.contains("timestamp") && first.contains("serialNumber") &&
         (first.contains("batteryState") || first.contains("powerSupply"));
}

MessageDamage read_state_lines(const std::string& file, const NamedBy& named_by,
                               const std::function<void(const MessageChannel&)>& on_channel,
                               const std::function<void(const TimedMessage&)>& on_message) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw named_by.error(file, "a file that cannot be read", "VDA 5050 states, one per line");
  MessageDamage damage;
  std::map<std::string, std::size_t> robots;
  for (std::string line; next_state_line(in, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const json state = state_in(line);
    const auto time_ns = state.is_object() ? utc_nanoseconds(text_at(state, "timestamp")) : std::nullopt;
    if (!time_ns || robots.size() > kMostRobots) {
      ++damage.broken_records;
      damage.truncated = in.eof();
      continue;
    }
    const std::string name = text_at(state, "serialNumber");
    const auto [robot, added] = robots.try_emplace(name, robots.size());
    if (added) on_channel({.topic = name, .type = std::string(kStateType), .encoding = "json"});
    on_message({.channel = robot->second, .log_time_ns = *time_ns, .data = line});
  }
  return damage;
}

}  // namespace joulepath
