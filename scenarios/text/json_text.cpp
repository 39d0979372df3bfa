#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "scenarios/text/value_builder.hpp"

namespace joulepath {
namespace {

/// Reads a text and counts the characters, which gives the places of the parser's events.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, std::size_t* read) : at_(at), read_(read) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    ++*read_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

 private:
  const char* at_;
  std::size_t* read_;
};

/// The library's message about a mistake, without its code and place.
std::string reason_of(const std::string& what) {
  const auto code = what.find("] ");
  std::string reason = code == std::string::npos ? what : what.substr(code + 2);
  const auto place = reason.find(": ");
  if (reason.rfind("parse error", 0) == 0 && place != std::string::npos) reason = reason.substr(place + 2);
  const auto last = reason.find("; last read");
  const auto rest = last == std::string::npos ? last : reason.find("; expected", last + 1);
  if (last != std::string::npos)
    reason.erase(last, rest == std::string::npos ? std::string::npos : rest - last);
  return reason;
}

/// The parser's events as values with their places.
class JsonEvents {
 public:
  JsonEvents(const std::string& text, std::string_view file, int first_line)
      : text_(text), builder_(file, PathStyle::pointer), line_(first_line) {}

  std::size_t* read() { return &read_; }
  Value take() { return builder_.take(); }

  bool null() { return builder_.null(literal(4)), true; }
  bool boolean(bool value) {
    const std::string word = value ? "true" : "false";
    return builder_.scalar(word, false, literal(word.size())), true;
  }
  bool number_integer(nlohmann::json::number_integer_t) { return number(); }
  bool number_unsigned(nlohmann::json::number_unsigned_t) { return number(); }
  bool number_float(nlohmann::json::number_float_t, const std::string&) { return number(); }
  bool string(std::string& value) {
    const auto place = token();
    end_ = read_;
    return builder_.scalar(std::move(value), true, place), true;
  }
  bool binary(nlohmann::json::binary_t&) { return false; }
  bool start_object(std::size_t) { return builder_.open(Value::Kind::map, literal(1)), true; }
  bool start_array(std::size_t) { return builder_.open(Value::Kind::list, literal(1)), true; }
  bool end_object() { return literal(1), builder_.close(), true; }
  bool end_array() { return literal(1), builder_.close(), true; }
  bool key(std::string& value) {
    const auto place = token();
    end_ = read_;
    return builder_.key(std::move(value), place), true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) {
    const auto place = place_of(std::min(position == 0 ? 0 : position - 1, text_.size()));
    builder_.fail(place, "", "text that is not JSON (" + reason_of(error.what()) + ")", "JSON",
                  "is a bracket, quote, comma or colon missing or extra here or before?");
  }

 private:
  /// The place of the token after the last one.
  ValueBuilder::Place token() {
    begin_ = std::min(text_.find_first_not_of(" \t\r\n:,", end_), text_.size());
    return place_of(begin_);
  }
  ValueBuilder::Place literal(std::size_t length) {
    const auto place = token();
    end_ = begin_ + length;
    return place;
  }
  /// A number keeps its digits; the parser has read one more character.
  bool number() {
    const auto place = token();
    end_ = std::min(text_.find_first_not_of("+-0123456789.eE", begin_), text_.size());
    return builder_.scalar(text_.substr(begin_, end_ - begin_), false, place), true;
  }
  /// Lines are counted from the last requested place.
  ValueBuilder::Place place_of(std::size_t offset) {
    for (; counted_ < offset; ++counted_)
      if (text_[counted_] == '\n') {
        ++line_;
        line_begin_ = counted_ + 1;
      }
    return {.line = line_, .column = static_cast<int>(offset - std::min(offset, line_begin_)) + 1};
  }

  const std::string& text_;
  ValueBuilder builder_;
  std::size_t read_{}, begin_{}, end_{}, counted_{}, line_begin_{};
  int line_;
};

}  // namespace

Value read_json_text(const std::string& text, std::string_view file, int first_line) {
  JsonEvents events(text, file, first_line);
  const char* begin = text.data();
  nlohmann::json::sax_parse(CountingIterator(begin, events.read()),
                            CountingIterator(begin + text.size(), events.read()), &events);
  return events.take();
}

}  // namespace joulepath
