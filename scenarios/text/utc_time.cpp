#include "scenarios/text/utc_time.hpp"

#include <charconv>
#include <chrono>

namespace joulepath {
namespace {

/// A number with exactly this many digits.
std::optional<int> digits_at(std::string_view text, std::size_t from, std::size_t count) {
  if (text.size() < from + count) return {};
  int value{};
  const char* begin = text.data() + from;
  const auto [end, error] = std::from_chars(begin, begin + count, value);
  return error == std::errc{} && end == begin + count && value >= 0 ? std::optional(value) : std::nullopt;
}

/// East of Greenwich, of what follows the seconds: nothing, Z or +02:00.
std::optional<std::chrono::minutes> offset_of(std::string_view zone) {
  if (zone.empty() || zone == "Z") return std::chrono::minutes(0);
  const bool shaped = zone.size() == 5 || (zone.size() == 6 && zone[3] == ':');
  if (!shaped || (zone[0] != '+' && zone[0] != '-')) return {};
  const auto hour = digits_at(zone, 1, 2), minute = digits_at(zone, zone.size() - 2, 2);
  if (!hour || !minute) return {};
  return (zone[0] == '-' ? -1 : 1) * std::chrono::minutes(60 * *hour + *minute);
}

}  // namespace

std::optional<std::uint64_t> utc_nanoseconds(std::string_view text) {
  using namespace std::chrono;
  if (text.size() < 19 || text[4] != '-' || text[7] != '-' || (text[10] != 'T' && text[10] != ' ') ||
      text[13] != ':' || text[16] != ':')
    return {};
  const auto y = digits_at(text, 0, 4), m = digits_at(text, 5, 2), d = digits_at(text, 8, 2),
             hour = digits_at(text, 11, 2), minute = digits_at(text, 14, 2), second = digits_at(text, 17, 2);
  if (!y || !m || !d || !hour || !minute || !second) return {};
  const year_month_day date{year(*y), month(static_cast<unsigned>(*m)), day(static_cast<unsigned>(*d))};
  constexpr int kLastYear = 2261;  // 64 bits hold the nanoseconds until 2262-04-11
  if (!date.ok() || *y < 1970 || *y > kLastYear || *hour > 23 || *minute > 59 || *second > 60) return {};
  nanoseconds fraction(0), unit(100'000'000);
  std::size_t end = 19;
  if (end < text.size() && text[end] == '.')
    for (++end; end < text.size() && text[end] >= '0' && text[end] <= '9'; ++end, unit /= 10)
      fraction += (text[end] - '0') * unit;
  const auto offset = offset_of(text.substr(end));
  if (!offset) return {};
  const nanoseconds whole =
      (sys_days(date) + hours(*hour) + minutes(*minute) + seconds(*second) - *offset).time_since_epoch();
  const nanoseconds total = whole + fraction;
  return total.count() < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(total.count()));
}

}  // namespace joulepath
