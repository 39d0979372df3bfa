#pragma once

#include <array>
#include <optional>

#include "benchmarks/paper/coefficients.hpp"

/// Figures that [P1] prints and that are not measurements (those are files in scenarios/paper/).
namespace joulepath::bench::printed {

/// Eqs. (31) and (32), in the order of kCoefficientNames. P1 of the paper goes with its column
/// "left motor", see docs/equations.md.
inline constexpr Sided<PowerCoefficients> kCoefficients{
    .left = {0.0203, 0.148, 0.0014, 0.102, 0.0017, 0.005, 0.373, 0.0034, 0.129},
    .right = {0.0203, 0.148, 0.0014, 0.0949, 0.0017, 0.005, 0.346, 0.0032, 0.111}};

/// Half a unit of the last printed digit: the effect of rounding alone.
inline constexpr Sided<PowerCoefficients> kCoefficientRounding{
    .left = {0.00005, 0.0005, 0.00005, 0.0005, 0.00005, 0.0005, 0.0005, 0.00005, 0.0005},
    .right = {0.00005, 0.0005, 0.00005, 0.00005, 0.00005, 0.0005, 0.0005, 0.00005, 0.0005}};

struct EstimateRow {
  double payload_kg{};  ///< as the table's heading says
  double acceleration_m_s2{};
  Sided<double> estimated_J{};
  bool doubtful{};  ///< the row's printed values contradict the rest of the paper
};

/// Table 4: straight line.
inline constexpr std::array<EstimateRow, 12> kStraight{{{0, 0.125, {60.48, 57.60}},
                                                        {0, 0.15, {60.99, 58.47}},
                                                        {0, 0.175, {63.57, 60.28}},
                                                        {0, 0.2, {64.90, 62.77}},
                                                        {0, 0.225, {66.13, 64.18}},
                                                        {0, 0.25, {65.14, 64.31}},
                                                        {8.25, 0.125, {65.11, 62.20}},
                                                        {8.25, 0.15, {67.16, 64.59}},
                                                        {8.25, 0.175, {70.02, 67.70}},
                                                        {8.25, 0.2, {72.97, 70.78}},
                                                        {8.25, 0.225, {74.34, 72.40}},
                                                        {8.25, 0.25, {78.06, 76.26}}}};

/// Table 6: along the Bezier curve, "right direction".
inline constexpr std::array<EstimateRow, 8> kBezier{{{0, 0.15, {22.65, 22.57}},
                                                     {0, 0.18, {23.00, 22.69}},
                                                     {0, 0.2, {25.60, 24.72}, true},
                                                     {0, 0.22, {26.19, 24.86}, true},
                                                     {10.5, 0.15, {28.47, 27.51}},
                                                     {10.5, 0.18, {31.67, 30.89}},
                                                     {10.5, 0.2, {32.30, 30.45}, true},
                                                     {10.5, 0.22, {31.39, 29.58}, true}}};

/// Fig. 10: left-turning, no payload.
inline constexpr EstimateRow kBezierLeft{0, 0.18, {26.56, 24.42}};

inline constexpr std::array<double, 6> kStraightAccelerations{0.125, 0.15, 0.175, 0.2, 0.225, 0.25};
inline constexpr std::array<double, 5> kStraightPayloads{0, 2.5, 5.7, 8.25, 10.5};

/// Table 5: |error| in percent, one row per acceleration, one column per payload.
inline constexpr double kStraightErrors[6][5] = {
    {7.42, 5.29, 3.82, 7.89, 9.25}, {3.13, 0.13, 3.69, 5.11, 8.46},  {5.99, 6.70, 0.69, 0.53, 2.85},
    {7.33, 7.20, 0.75, 0.20, 1.92}, {10.86, 8.10, 6.70, 5.33, 0.17}, {8.80, 9.85, 6.52, 7.94, 5.04}};

inline constexpr double kStraightFitnessPercent = 96.67;
inline constexpr double kBezierFitnessPercent = 81.25;  ///< Table 7: 26 of 32
inline constexpr double kHighestStraight_J = 162.7;     ///< Fig. 6
inline constexpr double kHighestBezier_J = 66.97;       ///< Fig. 12

}  // namespace joulepath::bench::printed
