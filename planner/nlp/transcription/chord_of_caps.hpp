#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "planner/nlp/transcription/rate_cap.hpp"

namespace joulepath::nlp {

/// Shares of a segment's length at which the cap inside is compared with the chord of the ends' caps.
inline constexpr std::array kInsideSegment{0.2, 0.4, 0.6, 0.8};
using CapsInside = std::array<double, kInsideSegment.size()>;

/// Squares of the rate at a segment's two ends such that the chord between them is below the caps inside, and
/// which caps determine them.
struct ChordOfCaps {
  std::array<double, 2> squared{};
  std::array<std::optional<std::size_t>, 2> bound{};  ///< place inside that bounds an end; none: its own cap
  std::optional<std::size_t> lowest{};  ///< place inside that lowers both ends; none: not lowered
  double share0{};                      ///< of the first end in the chord there, before
};

/// No chord below a cap c inside, at a share f of the length, begins above c/(1 - f) or ends above c/f. The
/// ends are lowered to these bounds, and from there in one ratio, by half at most: no end is below half of
/// the least of all caps.
inline ChordOfCaps chord_of_caps(double at0, double at1, const CapsInside& inside) {
  ChordOfCaps chord{.squared = {at0, at1}};
  const auto bound = [&](std::size_t end, double squared, std::size_t place) {
    if (squared < chord.squared[end]) chord.squared[end] = squared, chord.bound[end] = place;
  };
  for (std::size_t i = 0; i < inside.size(); ++i) {
    bound(0, inside[i] / (1 - kInsideSegment[i]), i);
    bound(1, inside[i] / kInsideSegment[i], i);
  }
  double least = 1;
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const double f = kInsideSegment[i], first = (1 - f) * chord.squared[0],
                 height = first + f * chord.squared[1];
    if (!(inside[i] < least * height)) continue;
    least = inside[i] / height;
    chord.lowest = i;
    chord.share0 = first / height;
  }
  for (double& squared : chord.squared) squared *= least;
  return chord;
}

}  // namespace joulepath::nlp
