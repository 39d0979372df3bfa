#include <algorithm>
#include <cmath>

#include "benchmarks/paper/drive.hpp"
#include "benchmarks/paper/printed.hpp"
#include "benchmarks/paper/sections.hpp"
#include "benchmarks/support/svg_plot.hpp"

namespace joulepath::bench {
namespace {

struct Fit {
  double fitness_percent{};        ///< tests with the energy of both wheels within 10 %
  double wheel_fitness_percent{};  ///< tests with each wheel's energy within 10 %
  double worst_percent{};          ///< largest |error| of the sum
  double worst_wheel_percent{};
};

/// Compares the d = 0 model with a robot whose center of mass lies d ahead, over the paper's matrix of
/// payloads and accelerations.
Fit fit_of(const Robot& nominal, double d_m, const std::vector<Track>& tracks,
           const std::vector<double>& payloads, const std::vector<double>& accelerations, double entry_m_s) {
  Robot displaced = nominal;
  displaced.geometry.center_of_mass_offset_m = d_m;
  const Plant model = make_nominal_plant(nominal), truth = make_nominal_plant(displaced);
  Fit fit;
  int tests = 0;
  for (const Track& track : tracks)
    for (double kg : payloads)
      for (double a : accelerations) {
        const SpeedProfile profile = ramp_then_cruise(entry_m_s, a, 4, track.length_m());
        const Sided<double> said = drive_energy_J(model, kg, track, profile, NegativePower::lost);
        const Sided<double> is = drive_energy_J(truth, kg, track, profile, NegativePower::lost);
        const double error = 100 * std::abs((said.left + said.right) / (is.left + is.right) - 1);
        double wheel_error = 0;
        for (Side side : kSides)
          wheel_error = std::max(wheel_error, 100 * std::abs(said[side] / is[side] - 1));
        fit.fitness_percent += error < 10, fit.wheel_fitness_percent += wheel_error < 10, ++tests;
        fit.worst_percent = std::max(fit.worst_percent, error);
        fit.worst_wheel_percent = std::max(fit.worst_wheel_percent, wheel_error);
      }
  fit.fitness_percent *= 100.0 / tests, fit.wheel_fitness_percent *= 100.0 / tests;
  return fit;
}

}  // namespace

void offset_section(PaperReport& report) {
  report.text +=
      "## Beyond the paper: a displaced center of mass\n\nThe paper's future work. Robots with the center of "
      "mass d ahead of the axle (chassis and payload), without noise or any other gap, against the d = 0 "
      "model: share of tests whose energy is met within 10 % (Eq. 33), and the largest error. Straight: the "
      "30 tests; curved: the Bezier curve both ways (entry 0.2 m/s), 32 tests; tight: a curve of a quarter "
      "of "
      "that size, 32 tests.\n\n| d m | straight: fitness %, worst % | curved: fitness %, worst % | curved, "
      "each "
      "wheel: fitness %, worst % | tight: fitness %, worst % | tight, each wheel: fitness %, worst % |\n"
      "|---|---|---|---|---|---|\n";
  const std::vector<double> a_straight(printed::kStraightAccelerations.begin(),
                                       printed::kStraightAccelerations.end());
  const std::vector<double> kg_straight(printed::kStraightPayloads.begin(), printed::kStraightPayloads.end());
  const std::vector<double> a_curve{0.15, 0.18, 0.2, 0.22}, kg_curve{0, 5.7, 8.25, 10.5};
  const auto tight = [](double bend) {
    return Track{.curve = BezierSegment({{{0, 0}, {0.675, 0}, {0.675, 0}, {0.675, bend * 0.675}}})};
  };
  Plot plot{.title = "Error of the d = 0 model against the robot's d",
            .x_label = "center of mass ahead of the axle (m)",
            .y_label = "largest energy error (%)",
            .from_zero = true};
  plot.series = {{.name = "straight, sum"},
                 {.name = "curve, sum"},
                 {.name = "curve, one wheel"},
                 {.name = "tight curve, sum"},
                 {.name = "tight curve, one wheel"}};
  for (double d : {0.0, 0.025, 0.05, 0.075, 0.1, 0.125, 0.15}) {
    const Fit straight = fit_of(report.robot, d, {{.straight_m = 10}}, kg_straight, a_straight, 0);
    const Fit curve = fit_of(report.robot, d, {paper_curve(1), paper_curve(-1)}, kg_curve, a_curve, 0.2);
    const Fit narrow = fit_of(report.robot, d, {tight(1), tight(-1)}, kg_curve, a_curve, 0.2);
    report.text +=
        text("| %g | %.1f, %.2f | %.1f, %.2f | %.1f, %.2f | %.1f, %.2f | %.1f, %.2f |\n", d,
             straight.fitness_percent, straight.worst_percent, curve.fitness_percent, curve.worst_percent,
             curve.wheel_fitness_percent, curve.worst_wheel_percent, narrow.fitness_percent,
             narrow.worst_percent, narrow.wheel_fitness_percent, narrow.worst_wheel_percent);
    const double values[] = {straight.worst_percent, curve.worst_percent, curve.worst_wheel_percent,
                             narrow.worst_percent, narrow.worst_wheel_percent};
    for (std::size_t i = 0; i < 5; ++i) plot.series[i].x.push_back(d), plot.series[i].y.push_back(values[i]);
  }
  write_svg(plot, report.plots_folder + "/offset_error.svg");
  report.text += "\n![offset](paper/offset_error.svg)\n\n";
}

}  // namespace joulepath::bench
