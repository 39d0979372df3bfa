#include <algorithm>
#include <cmath>

#include "benchmarks/paper/printed.hpp"
#include "benchmarks/paper/sections.hpp"

namespace joulepath::bench {
namespace {

int within_rounding(const Robot& robot, Side side) {
  const PowerCoefficients ours = straight_line_coefficients(robot, side);
  int count = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    count += std::abs(ours[i] - printed::kCoefficients[side][i]) <=
             printed::kCoefficientRounding[side][i] * (1 + 1e-9);
  return count;
}

}  // namespace

void coefficients_section(PaperReport& report) {
  report.text +=
      "## Equations 31 and 32 from physical parameters\n\n"
      "`P = rho tau^2 + q' tau`, `tau = (J0 + j m_p) q'' + nu q' + T_m`. `rounding`: within half a unit of "
      "the "
      "last printed digit.\n\n"
      "| term | left ours | left printed | deviation % | rounding | right ours | right printed | deviation % "
      "| "
      "rounding |\n|---|---|---|---|---|---|---|---|---|\n";
  const Sided<PowerCoefficients> ours{straight_line_coefficients(report.robot, Side::left),
                                      straight_line_coefficients(report.robot, Side::right)};
  for (std::size_t i = 0; i < ours.left.size(); ++i) {
    report.text += text("| %s |", kCoefficientNames[i]);
    for (Side side : kSides) {
      const double printed_value = printed::kCoefficients[side][i];
      const double deviation = ours[side][i] - printed_value;
      report.text +=
          text(" %.5f | %g | %+.2f | %s |", ours[side][i], printed_value, 100 * deviation / printed_value,
               std::abs(deviation) <= printed::kCoefficientRounding[side][i] * (1 + 1e-9) ? "yes" : "no");
    }
    report.text += "\n";
  }
  Robot other = report.robot;
  other.motor.left.gear_ratio = other.motor.right.gear_ratio = 24.94;
  const double dropped = dropped_coefficient(report.robot, Side::left) * 10.5 * 10.5;
  const int left = within_rounding(report.robot, Side::left),
            right = within_rounding(report.robot, Side::right);
  report.text += text(
      "\nWithin rounding: %d of 9 left, %d of 9 right with n = %.4g; with n = 24.94: %d and %d. n is "
      "inferred from "
      "the constant and the q' term (R/(Kt n)^2 = 0.129/0.3728^2), I_w + I_s from the q'' q' term; neither "
      "is "
      "printed. The printed polynomials leave out %.6f q''^2 m_p^2 (%.1f %% of all that goes with q''^2 at "
      "10.5 kg).\n\n",
      left, right, report.robot.motor.left.gear_ratio, within_rounding(other, Side::left),
      within_rounding(other, Side::right), dropped_coefficient(report.robot, Side::left),
      100 * dropped / (dropped + ours.left[0] + 10.5 * ours.left[2]));
  report.summary.push_back({"Eqs. 31, 32", "consistent",
                            text("%d + %d of 18 coefficients within rounding", left, right),
                            "18 coefficients", "n and I_w + I_s inferred from them, the rest as printed"});
}

}  // namespace joulepath::bench
