#pragma once
// Forced into the mutated copies of sources by mutate.py: all mutants are compiled at once, and the
// environment variable MUTANT chooses the one that is active. A binary operator of a site gets a marker
// between its operands, `a + b` becomes `a + Binary<7, '-'>{} + b`, so that precedence stays as it was. A
// site notes that it was reached; MUTANT_REACHED names the file for these notes. In constant expressions no
// mutant is active.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <type_traits>
#include <utility>

namespace mutant {

inline constexpr int kMost = 1000;
inline int chosen = 0;
inline unsigned char reached[kMost] = {};

__attribute__((constructor(101))) inline void choose() {
  if (const char* id = std::getenv("MUTANT")) chosen = std::atoi(id);
}

__attribute__((destructor(101))) inline void write_reached() {
  const char* path = std::getenv("MUTANT_REACHED");
  std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "w");
  if (file == nullptr) return;
  for (int id = 0; id < kMost; ++id)
    if (reached[id] != 0) std::fprintf(file, "%d\n", id);
  std::fclose(file);
}

inline bool live(int id) {
  reached[id] = 1;
  return chosen == id;
}

constexpr bool active(int id) { return std::is_constant_evaluated() ? false : live(id); }

/// An expression's value: Eigen's expressions refer to their operands, their plain objects do not.
template <class T, class = void>
struct Plain {
  using type = std::decay_t<T>;
};
template <class T>
struct Plain<T, std::void_t<typename std::decay_t<T>::PlainObject>> {
  using type = typename std::decay_t<T>::PlainObject;
};

template <int id, char replacement>
struct Binary {};
template <int id, char replacement, class T>
struct Half {
  const T& left;
};

// `<` and `>` stand for themselves, `l` for <= and `g` for >=.
template <char op, class T, class U>
constexpr auto applied(const T& left, const U& right) {
  if constexpr (op == '+')
    return static_cast<typename Plain<decltype(left + right)>::type>(left + right);
  else if constexpr (op == '-')
    return static_cast<typename Plain<decltype(left - right)>::type>(left - right);
  else if constexpr (op == '*')
    return static_cast<typename Plain<decltype(left * right)>::type>(left * right);
  else if constexpr (op == '/')
    return static_cast<typename Plain<decltype(left / right)>::type>(left / right);
  else if constexpr (op == '<')
    return left < right;
  else if constexpr (op == '>')
    return left > right;
  else if constexpr (op == 'l')
    return left <= right;
  else
    return left >= right;
}

// The two halves of one operator: `left op marker`, then `half op right`.
#define JOULEPATH_MUTANT_OPERATOR(symbol, original)                          \
  template <class T, int id, char op>                                        \
  constexpr Half<id, op, T> operator symbol(const T& left, Binary<id, op>) { \
    return {left};                                                           \
  }                                                                          \
  template <int id, char op, class T, class U>                               \
  constexpr auto operator symbol(Half<id, op, T> half, const U& right)       \
      ->decltype(applied<original>(half.left, right)) {                      \
    if (active(id)) return applied<op>(half.left, right);                    \
    return applied<original>(half.left, right);                              \
  }
JOULEPATH_MUTANT_OPERATOR(+, '+')
JOULEPATH_MUTANT_OPERATOR(-, '-')
JOULEPATH_MUTANT_OPERATOR(*, '*')
JOULEPATH_MUTANT_OPERATOR(/, '/')
JOULEPATH_MUTANT_OPERATOR(<, '<')
JOULEPATH_MUTANT_OPERATOR(>, '>')
JOULEPATH_MUTANT_OPERATOR(<=, 'l')
JOULEPATH_MUTANT_OPERATOR(>=, 'g')
#undef JOULEPATH_MUTANT_OPERATOR

/// `-x` becomes `Negative<7>{} * x`: the mutant drops the sign.
template <int id>
struct Negative {};
template <int id, class U>
constexpr auto operator*(Negative<id>, const U& value) {
  using Value = typename Plain<decltype(-value)>::type;
  return active(id) ? static_cast<Value>(value) : static_cast<Value>(-value);
}

/// `x += y` becomes `x += Opposite<7>{} += y`: assignments group from the right.
template <int id>
struct Opposite {};
template <int id, class U>
constexpr auto operator+=(Opposite<id>, const U& value) {
  using Value = typename Plain<decltype(-value)>::type;
  return active(id) ? static_cast<Value>(-value) : static_cast<Value>(value);
}

/// `x += y` becomes `x += Dropped<7>{} += y`: the mutant assigns.
template <int id>
struct Dropped {};
template <int id, class U>
struct Assigned {
  U value;
};
template <int id, class U>
constexpr auto operator+=(Dropped<id>, const U& value) {
  return Assigned<id, typename Plain<U>::type>{value};
}
template <class T, int id, class U>
constexpr decltype(auto) operator+=(T&& sum, const Assigned<id, U>& assigned) {
  if (active(id)) return sum = assigned.value;
  return sum += assigned.value;
}

template <int id, class... Values>
constexpr auto max(const Values&... values) {
  return active(id) ? std::min(values...) : std::max(values...);
}
template <int id, class T>
constexpr T max(std::initializer_list<T> values) {
  return active(id) ? std::min(values) : std::max(values);
}
template <int id, class... Values>
constexpr auto min(const Values&... values) {
  return active(id) ? std::max(values...) : std::min(values...);
}
template <int id, class T>
constexpr T min(std::initializer_list<T> values) {
  return active(id) ? std::max(values) : std::min(values);
}

template <int id, class T>
constexpr auto abs(const T& value) {
  return active(id) ? static_cast<decltype(std::abs(value))>(value) : std::abs(value);
}

template <int id>
constexpr double constant(double original, double other) {
  return active(id) ? other : original;
}
/// For constants that are no part of a constant expression: the mutant is active in initial values, too.
template <int id>
inline double live_constant(double original, double other) {
  return live(id) ? other : original;
}

}  // namespace mutant
