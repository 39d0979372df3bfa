#include "extensions/vda5050/state_lines.hpp"

#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "scenarios/text/next_line.hpp"
#include "scenarios/text/shallow_json.hpp"

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

/// A number with exactly this many digits.
std::optional<int> digits(std::string_view text, std::size_t from, std::size_t count) {
  if (text.size() < from + count) return {};
  int value{};
  const char* begin = text.data() + from;
  const auto [end, error] = std::from_chars(begin, begin + count, value);
  return error == std::errc{} && end == begin + count && value >= 0 ? std::optional(value) : std::nullopt;
}

std::string text_at(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::optional<std::uint64_t> utc_nanoseconds(std::string_view text) {
  using namespace std::chrono;
  if (text.size() < 20 || text.back() != 'Z' || text[4] != '-' || text[7] != '-' || text[10] != 'T')
    return {};
  const auto y = digits(text, 0, 4), m = digits(text, 5, 2), d = digits(text, 8, 2),
             hour = digits(text, 11, 2), minute = digits(text, 14, 2), second = digits(text, 17, 2);
  if (!y || !m || !d || !hour || !minute || !second) return {};
  const year_month_day date{year(*y), month(static_cast<unsigned>(*m)), day(static_cast<unsigned>(*d))};
  constexpr int kLastYear = 2261;  // 64 bits hold the nanoseconds until 2262-04-11
  if (!date.ok() || *y < 1970 || *y > kLastYear || *hour > 23 || *minute > 59 || *second > 60) return {};
  const auto whole = sys_days(date) + hours(*hour) + minutes(*minute) + seconds(*second);
  auto total = static_cast<std::uint64_t>(duration_cast<nanoseconds>(whole.time_since_epoch()).count());
  std::uint64_t unit = 100'000'000;
  for (std::size_t i = 20; text[19] == '.' && i + 1 < text.size(); ++i, unit /= 10) {
    if (text[i] < '0' || text[i] > '9') return {};
    total += unit * static_cast<std::uint64_t>(text[i] - '0');
  }
  return text[19] == '.' || text.size() == 20 ? std::optional(total) : std::nullopt;
}

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
