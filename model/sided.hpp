#pragma once

namespace joulepath {

/// The two sides of the robot, as seen when driving forward.
enum class Side { left, right };

/// One value for each wheel. The paper counts wheel 1 as the right one and wheel 2 as the left;
/// here they always have names.
template <class T>
struct Sided {
  T left{};
  T right{};

  T& operator[](Side side) { return side == Side::left ? left : right; }
  const T& operator[](Side side) const { return side == Side::left ? left : right; }
  friend bool operator==(const Sided&, const Sided&) = default;
};

inline constexpr Side kSides[] = {Side::left, Side::right};

/// The sign with which a wheel's speed contains the yaw rate: r q' = v + side_sign(side) l omega.
constexpr double side_sign(Side side) { return side == Side::left ? -1.0 : 1.0; }

constexpr const char* side_name(Side side) { return side == Side::left ? "left" : "right"; }

/// Calls function(side, value) for both sides and collects what it returns.
template <class T, class Function>
auto map_sides(const Sided<T>& values, Function&& function) {
  using Result = decltype(function(Side::left, values.left));
  return Sided<Result>{function(Side::left, values.left), function(Side::right, values.right)};
}

}  // namespace joulepath
