#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace joulepath {

template <class T>
inline constexpr bool kIsPlainNumber = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Writes values as bytes: numbers in their memory representation, containers with their size first.
///
/// A struct is serialized through `each_field(archive, value)` in its namespace, which passes its fields to
/// the archive. The function uses a structured binding, so that a new field is a compile error until it is
/// listed.
class ByteWriter {
 public:
  template <class... Values>
  void operator()(const Values&... values) {
    (write(values), ...);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void write(const std::string& text) { write(std::string_view(text)); }
  void write(std::string_view text) {
    write(text.size());
    bytes_.append(text);
  }
  template <class T>
  void write(const T& value) {
    if constexpr (kIsPlainNumber<T>)
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    else
      each_field(*this, const_cast<T&>(value));  // the writer does not change the fields
  }
  template <class T>
  void write(const std::vector<T>& values) {
    write(values.size());
    if constexpr (std::is_same_v<T, double>)
      bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
    else
      for (const T& value : values) write(value);
  }
  template <class T, std::size_t N>
  void write(const std::array<T, N>& values) {
    for (const T& value : values) write(value);
  }
  template <class T>
  void write(const std::optional<T>& value) {
    write(value.has_value());
    if (value) write(*value);
  }
  template <class Key, class T>
  void write(const std::map<Key, T>& values) {
    write(values.size());
    for (const auto& [key, value] : values) (*this)(key, value);
  }

  std::string bytes_{};
};

/// Reads what a ByteWriter wrote, in the same order. Bytes that do not fit set the failure state; the reader
/// never reads beyond its text.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }
  /// True if everything was read without a failure.
  bool finished() const { return !failed_ && left_.empty(); }
  bool failed() const { return failed_; }
  void fail() { failed_ = true; }

 private:
  bool take(void* to, std::size_t size) {
    if (failed_ || size > left_.size()) return !(failed_ = true);
    if (size > 0) std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
    return true;
  }
  /// Size of a container; each of its elements takes at least one byte.
  std::size_t size() {
    std::size_t count = 0;
    if (take(&count, sizeof count) && count > left_.size()) failed_ = true;
    return failed_ ? 0 : count;
  }
  void read(std::string& text) {
    text.resize(size());
    take(text.data(), text.size());
  }
  template <class T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      unsigned char byte = 0;
      take(&byte, 1);
      value = byte != 0;
    } else if constexpr (kIsPlainNumber<T>) {
      take(&value, sizeof value);
    } else {
      each_field(*this, value);
    }
  }
  template <class T>
  void read(std::vector<T>& values) {
    values.clear();
    for (std::size_t left = size(); left > 0 && !failed_; --left) read(values.emplace_back());
  }
  template <class T, std::size_t N>
  void read(std::array<T, N>& values) {
    for (T& value : values) read(value);
  }
  template <class T>
  void read(std::optional<T>& value) {
    bool given = false;
    read(given);
    value.reset();
    if (given && !failed_) read(value.emplace());
  }
  template <class Key, class T>
  void read(std::map<Key, T>& values) {
    values.clear();
    for (std::size_t left = size(); left > 0 && !failed_; --left) {
      Key key{};
      T value{};
      (*this)(key, value);
      values.emplace(std::move(key), std::move(value));
    }
  }

  std::string_view left_;
  bool failed_{};
};

}  // namespace joulepath
